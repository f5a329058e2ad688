// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "capi/handles.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::capi {
namespace {

// In version 1 of the interface.
constexpr std::size_t kFuseBytes = offsetof(vdbfuse_fuse_options, progress_data) + sizeof(void*);

vdbfuse_fuse_options defaultFuse() {
  vdbfuse_fuse_options options{};
  options.struct_size = sizeof options;
  options.outliers = options.thickness = -1;
  return options;
}

Method methodOf(std::int32_t method) {
  if (method == VDBFUSE_METHOD_VISIBILITY) return Method::Visibility;
  if (method == VDBFUSE_METHOD_TSDF) return Method::Tsdf;
  throw InvalidArgument("options.method", std::to_string(method) + " is neither 0 nor 1");
}

std::optional<Box> domainOf(const vdbfuse_fuse_options& options) {
  const Eigen::Map<const Eigen::Vector3d> low(options.domain_min), high(options.domain_max);
  if (low.isZero(0) && high.isZero(0)) return std::nullopt;
  return Box(low, high);
}

ReconstructOptions reconstructOptions(const vdbfuse_fuse_options& from) {
  ReconstructOptions options;
  options.method = methodOf(from.method);
  options.voxel = from.voxel, options.resolution = from.resolution;
  options.domain = domainOf(from);
  if (from.sensor != nullptr) options.noise = sensorPreset(from.sensor).noise;
  options.noise_scale = from.noise_scale;
  if (!(from.outliers < 0)) options.outliers = from.outliers;
  if (!(from.thickness < 0)) options.thickness = from.thickness;
  options.tsdf.truncation = from.truncation;
  options.trim = from.trim, options.min_component = from.min_component;
  options.simplify = static_cast<std::size_t>(from.simplify);
  options.memory = static_cast<std::size_t>(from.memory_bytes);
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
  return options;
}

}  // namespace

Progress::Callback FuseRequest::callback() const {
  if (progress == nullptr) return {};
  return [call = progress, data = progress_data](std::string_view step, double fraction) {
    return call(std::string(step).c_str(), fraction, data) == 0;
  };
}

FuseRequest fuseRequestOf(const vdbfuse_fuse_options* options) {
  const vdbfuse_fuse_options from =
      options == nullptr ? defaultFuse() : readStruct(options, defaultFuse(), kFuseBytes, "options");
  if (from.threads < 0) throw InvalidArgument("options.threads", "must not be negative");
  FuseRequest request;
  request.finish.reconstruct = reconstructOptions(from);
  request.finish.key_views = {from.key_distance, from.key_angle};
  if (from.colors != 0) request.finish.colors = FinishOptions::Colors::Keep;
  request.threads = from.threads;
  request.progress = from.progress, request.progress_data = from.progress_data;
  return request;
}

}  // namespace vdbfuse::capi

using namespace vdbfuse;
using namespace vdbfuse::capi;

vdbfuse_status vdbfuse_fuse_options_init(vdbfuse_fuse_options* options, uint64_t struct_size) {
  return guarded([&] { writeStruct(defaultFuse(), struct_size, kFuseBytes, "options", options); });
}

vdbfuse_status vdbfuse_fuse(const vdbfuse_views* views, const vdbfuse_fuse_options* options,
                            vdbfuse_mesh** out) {
  return guardedHandle(out, [&] {
    requireNotNull(views, "views");
    const FuseRequest request = fuseRequestOf(options);
    const ThreadLimit threads(request.threads);
    const Progress progress(request.callback());
    const ViewSequence sequence = views->sequence();
    Reconstruction result = reconstruct(sequence, request.finish.reconstruct, progress);
    if (request.finish.colors == FinishOptions::Colors::Keep) colorReconstruction(sequence, result, progress);
    return new vdbfuse_mesh{std::move(result.mesh)};
  });
}
