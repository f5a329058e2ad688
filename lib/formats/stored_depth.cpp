// SPDX-License-Identifier: Apache-2.0
#include "formats/stored_depth.h"

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/jpeg.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

void limitDepth(Image<float>& depth, const ReadOptions& options) {
  for (float& d : depth) {
    if (d < options.min_depth || d > options.max_depth) d = kInvalidDepth;
  }
}

}  // namespace

DepthEncoding encodingFor(const ReadOptions& options, const Projection& projection, DepthKind kind,
                          double length_scale) {
  DepthEncoding encoding;
  encoding.kind = options.depth_kind.value_or(kind);
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
  limitDepth(depth, options);
  return depth;
}

void limitPointDepth(Image<float>& depth, const ReadOptions& options) {
  const auto scale = static_cast<float>(options.depth_scale.value_or(1.0));
  for (float& d : depth) d *= scale;
  normaliseInvalid(depth);
  limitDepth(depth, options);
}

void requirePointOptions(const ReadOptions& options, DepthKind natural, const std::string& format) {
  if (options.depth_kind.value_or(natural) != natural)
    throw InvalidArgument("depth_kind", format + " holds points, whose depth is " +
                                            (natural == DepthKind::Range ? "the range" : "z"));
  if (options.intrinsics)
    throw InvalidArgument("intrinsics", format + " holds points, not the images of a camera");
}

Image<Rgb8> readPicture(const std::filesystem::path& path) {
  return path.extension() == ".png" ? readPngRgb(path) : readJpeg(path);
}

std::pair<int, int> pictureSize(const std::filesystem::path& path) {
  if (path.extension() != ".png") return readJpegSize(path);
  const PngHeader header = readPngHeader(path);
  return {header.width, header.height};
}

}  // namespace vdbfuse
