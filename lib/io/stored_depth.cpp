// SPDX-License-Identifier: Apache-2.0
#include "io/stored_depth.h"

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/jpeg.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {

DepthEncoding encodingFor(const ReadOptions& options, const Projection& projection, double length_scale) {
  DepthEncoding encoding;
  encoding.kind = options.depth_kind.value_or(DepthKind::Z);
  const bool is_length = encoding.kind == DepthKind::Z || encoding.kind == DepthKind::Range;
  encoding.scale = options.depth_scale.value_or(is_length ? length_scale : 1.0);
  if (encoding.kind != DepthKind::Disparity) return encoding;
  const auto* camera = std::get_if<Pinhole>(&projection);
  if (camera == nullptr) throw InvalidArgument("depth_kind", "disparity needs a pinhole camera");
  if (!options.baseline)
    throw InvalidArgument("baseline", "disparity needs the distance between the cameras");
  encoding.focal_baseline = camera->fx * *options.baseline;
  return encoding;
}

Image<float> sensorDepth(Image<float> stored, const Projection& projection, const DepthEncoding& encoding,
                         const ReadOptions& options) {
  Image<float> depth = toSensorDepth(std::move(stored), projection, encoding);
  for (float& d : depth) {
    if (d < options.min_depth || d > options.max_depth) d = kInvalidDepth;
  }
  return depth;
}

Image<Rgb8> readPicture(const std::filesystem::path& path) {
  return path.extension() == ".png" ? readPngRgb(path) : readJpeg(path);
}

}  // namespace vdbfuse
