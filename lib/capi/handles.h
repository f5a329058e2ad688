// SPDX-License-Identifier: Apache-2.0
// What the handles of the C interface hold, and the border that no exception crosses.
#pragma once

#include <cstring>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/capi/vdbfuse.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/pipeline/scanner.h"
#include "vdbfuse/sensor/view_sequence.h"

// The names of the C interface. NOLINTBEGIN(readability-identifier-naming)
struct vdbfuse_views {
  std::vector<vdbfuse::ViewHeader> headers;
  std::vector<std::function<vdbfuse::DepthMap()>> loaders;
  std::map<std::size_t, vdbfuse::View> lent;  ///< views whose images somebody points into

  vdbfuse::ViewSequence sequence() const;
};
struct vdbfuse_mesh {
  vdbfuse::TriangleMesh mesh;
};
struct vdbfuse_scanner {
  vdbfuse::Scanner scanner;
};
struct vdbfuse_preview {
  std::vector<vdbfuse_mesh> changed;
  std::vector<vdbfuse::Index3> changed_origins, removed_origins;
  vdbfuse::ViewId newest = 0;
};
// NOLINTEND(readability-identifier-naming)

namespace vdbfuse::capi {

/// The status of the exception that is being handled; its words become this thread's last error.
vdbfuse_status statusOfException() noexcept;

/// Calls body() and makes a status of what it throws.
template <class Body>
vdbfuse_status guarded(const Body& body) noexcept {
  try {
    body();
    return VDBFUSE_OK;
  } catch (...) {
    return statusOfException();
  }
}

/// Throws InvalidArgument for NULL.
void requireNotNull(const void* pointer, const char* argument);

/// Gives *out a new handle holding what make() returns, or NULL where that throws.
template <class Handle, class Make>
vdbfuse_status guardedHandle(Handle** out, const Make& make) noexcept {
  if (out != nullptr) *out = nullptr;
  return guarded([&] {
    requireNotNull(out, "out");
    *out = make();
  });
}

/// The value that a caller's number stands for. Throws InvalidArgument for any other number.
template <class Enum>
Enum choice(std::int32_t number, std::initializer_list<Enum> values, const char* argument) {
  if (number < 0 || static_cast<std::size_t>(number) >= values.size())
    throw InvalidArgument(argument,
                          std::to_string(number) + " is none of 0 to " + std::to_string(values.size() - 1));
  return values.begin()[number];
}

/// Throws InvalidArgument unless a struct has at least the fields of the first version and none that are not
/// known.
void requireStructSize(std::uint64_t size, std::size_t first, std::size_t now, const char* argument);

/// A struct of the caller's, perhaps shorter than ours, on top of the defaults. `first`: bytes that it had in
/// the first version of this interface. Throws InvalidArgument.
template <class Struct>
Struct readStruct(const Struct* given, const Struct& defaults, std::size_t first, const char* argument) {
  requireNotNull(given, argument);
  requireStructSize(given->struct_size, first, sizeof(Struct), argument);
  Struct result = defaults;
  std::memcpy(&result, given, given->struct_size);
  return result;
}

/// The other way: as much as the caller's struct holds. Throws InvalidArgument.
template <class Struct>
void writeStruct(Struct value, std::uint64_t size, std::size_t first, const char* argument, Struct* out) {
  requireNotNull(out, argument);
  requireStructSize(size, first, sizeof(Struct), argument);
  value.struct_size = size;
  std::memcpy(out, &value, size);
}

/// The view that a caller describes, with copies of its images. Throws InvalidArgument.
View viewOf(const vdbfuse_view* view);

/// Throws InvalidArgument unless 16 numbers are a pose.
RigidTransform poseOf(const double* world_from_camera);

/// What a caller's options mean; of NULL, the defaults. Throws InvalidArgument.
struct FuseRequest {
  FinishOptions finish;
  int threads = 0;
  vdbfuse_progress progress = nullptr;
  void* progress_data = nullptr;

  Progress::Callback callback() const;
};
FuseRequest fuseRequestOf(const vdbfuse_fuse_options* options);

}  // namespace vdbfuse::capi
