// SPDX-License-Identifier: Apache-2.0
// Which vdbfuse this is. The build reads its version from here. Plain macros, so that C can include them,
// too.
#pragma once

#define VDBFUSE_VERSION_MAJOR 0
#define VDBFUSE_VERSION_MINOR 1
#define VDBFUSE_VERSION_PATCH 0
/// Of these headers: major.minor.patch.
#define VDBFUSE_VERSION "0.1.0"

/// Programs run with every library of the same SOVERSION (the end of the name of the shared library,
/// libvdbfuse.so.0.1), and have to be compiled anew for another. Before 1.0 a minor version may break its
/// users, so that it is major.minor.
#define VDBFUSE_SOVERSION "0.1"

/// In preprocessor conditions: whether these headers are of that version or of a later one.
#define VDBFUSE_VERSION_AT_LEAST(major, minor, patch)                                        \
  (VDBFUSE_VERSION_MAJOR * 1000000 + VDBFUSE_VERSION_MINOR * 1000 + VDBFUSE_VERSION_PATCH >= \
   (major)*1000000 + (minor)*1000 + (patch))

#ifdef __cplusplus
namespace vdbfuse {

/// VDBFUSE_VERSION of the library that is linked. A program may have been compiled with the headers of
/// another.
const char* version();

}  // namespace vdbfuse
#endif
