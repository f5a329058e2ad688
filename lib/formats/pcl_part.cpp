// SPDX-License-Identifier: Apache-2.0
#include "formats/pcl_part.h"

#include <dlfcn.h>

#include "sensor/pcl_part.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;

// The folder of the library, or of the program where it is linked statically.
fs::path ownFolder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&ownFolder), &info) == 0) return {};
  return fs::absolute(info.dli_fname).parent_path();
}

fs::path findPart() {
  const fs::path folder = ownFolder();
  for (const char* place : {".", "../lib", ".."}) {
    fs::path candidate = folder / place / VDBFUSE_PCL_LIBRARY;
    if (fs::exists(candidate)) return candidate;
  }
  return {};
}

ReadPcdPoints* openPart(const fs::path& path) {
  const fs::path part = findPart();
  if (part.empty())
    throw IoError(path,
                  "reading PCD needs the PCL part (vdbfuse_pcl), which was not built or is not installed");
  void* library = dlopen(part.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* function = library == nullptr ? nullptr : dlsym(library, kReadPcdPointsSymbol);
  if (function == nullptr)
    throw IoError(path, "reading PCD needs the PCL part, which cannot be opened: " + std::string(dlerror()));
  return reinterpret_cast<ReadPcdPoints*>(function);
}

}  // namespace

PointImage readPcdPoints(const fs::path& path) {
  static ReadPcdPoints* const read = openPart(path);
  PointImage points;
  read(path, points);
  return points;
}

}  // namespace vdbfuse::io
