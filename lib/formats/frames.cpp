// SPDX-License-Identifier: Apache-2.0
#include "formats/frames.h"

#include <algorithm>
#include <memory>

#include "formats/stored_depth.h"
#include "io/folder.h"
#include "io/image_size.h"
#include "io/raster.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using io::RasterHeader;

// Shared by all copies of the sequence.
struct Source {
  std::vector<Frame> frames;
  FrameFormat format;
  ReadOptions options;
};

void requireFile(const fs::path& path, const std::string& what) {
  std::error_code error;
  if (!fs::exists(path, error)) throw IoError(path, "", what, "nothing of that name");
}

RasterHeader depthHeader(const Frame& frame) {
  requireFile(frame.depth, "the depth map of view " + frame.header.name);
  const RasterHeader header = io::readRasterHeader(frame.depth);
  if (header.bits <= 8) throw IoError(frame.depth, "", "depths of 16 bits or more", header.text());
  return header;
}

void checkConfidence(const Frame& frame, const RasterHeader& depth) {
  if (frame.confidence.empty()) return;
  requireFile(frame.confidence, "the confidence of view " + frame.header.name);
  const RasterHeader found = io::readRasterHeader(frame.confidence);
  if (found.width != depth.width || found.height != depth.height) {
    throw IoError(frame.confidence, "", sizeText(depth.width, depth.height) + " pixels as in the depth map",
                  sizeText(found.width, found.height));
  }
}

Pinhole cameraFor(const Pinhole& stored, const RasterHeader& depth, const ReadOptions& options) {
  Pinhole camera = stored;
  if (stored.width > 0) camera = resized(stored, depth.width, depth.height);
  camera.width = depth.width, camera.height = depth.height;
  if (!options.intrinsics) return camera;
  const auto& [fx, fy, cx, cy] = *options.intrinsics;
  camera.fx = fx, camera.fy = fy, camera.cx = cx, camera.cy = cy;
  return camera;
}

double scaleOf(const FrameFormat& format, const RasterHeader& depth) {
  return depth.isFloat() ? format.float_scale : format.integer_scale;
}

// What stands for "nothing" beside zero and what is not finite.
void dropMarks(Image<float>& stored, const RasterHeader& header) {
  constexpr float kSaturated = 65535, kLargestHalf = 65504, kFarAway = 1e9F;
  const bool is_exr = header.kind == io::RasterKind::Exr;
  const bool is_saturated = header.number == RasterHeader::Number::Unsigned && header.bits == 16;
  if (!is_exr && !is_saturated) return;
  const float limit = is_saturated ? kSaturated : header.bits == 16 ? kLargestHalf : kFarAway;
  std::replace_if(
      stored.begin(), stored.end(), [&](float v) { return v >= limit; }, kInvalidDepth);
}

std::string invalidText(const RasterHeader& header) {
  if (header.number == RasterHeader::Number::Unsigned && header.bits == 16) return "0 and 65535";
  if (header.kind == io::RasterKind::Exr) return "0, not finite, 1e9 and above (half: 65504)";
  return header.isFloat() ? "0, negative, not finite" : "0 and negative";
}

Image<float> readOfSize(const fs::path& path, const Projection& projection) {
  Image<float> image = io::readRaster(path);
  if (image.width() != imageWidth(projection) || image.height() != imageHeight(projection))
    throw IoError(path, "", sizeText(imageWidth(projection), imageHeight(projection)) + " pixels as before",
                  sizeText(image.width(), image.height()));
  return image;
}

DepthMap loadFrame(const Source& source, std::size_t index) {
  const Frame& frame = source.frames[index];
  const Projection& projection = frame.header.projection;
  const RasterHeader header = depthHeader(frame);
  Image<float> stored = readOfSize(frame.depth, projection);
  dropMarks(stored, header);
  DepthMap map;
  map.depth =
      sensorDepth(std::move(stored), projection,
                  encodingFor(source.options, projection, source.format.kind, scaleOf(source.format, header)),
                  source.options);
  if (!frame.confidence.empty()) map.confidence = readOfSize(frame.confidence, projection);
  if (source.options.color == ReadOptions::Color::Load && !frame.color.empty())
    map.color = readPicture(frame.color);
  return map;
}

void addNotes(const std::vector<Frame>& frames, std::vector<std::string>& notes) {
  const auto pictures = static_cast<std::size_t>(
      std::count_if(frames.begin(), frames.end(), [](const Frame& f) { return !f.color.empty(); }));
  if (pictures > 0 && pictures < frames.size())
    notes.push_back("colour for " + std::to_string(pictures) + " of " + counted(frames.size(), "view"));
  const Frame& first = frames.front();
  const auto& camera = std::get<Pinhole>(first.header.projection);
  if (camera.cx < 0 || camera.cy < 0 || camera.cx >= camera.width || camera.cy >= camera.height) {
    notes.push_back("the principal point lies outside the " + sizeText(camera.width, camera.height) +
                    " depth map of view " + first.header.name);
  }
}

}  // namespace

Pinhole resized(const Pinhole& camera, int width, int height) {
  const double sx = static_cast<double>(width) / camera.width,
               sy = static_cast<double>(height) / camera.height;
  Pinhole result = camera;
  result.width = width, result.height = height;
  result.fx *= sx, result.fy *= sy;
  result.cx = (camera.cx + 0.5) * sx - 0.5, result.cy = (camera.cy + 0.5) * sy - 0.5;
  return result;
}

RigidTransform openGlFromCamera() {
  RigidTransform flip = RigidTransform::Identity();
  flip.linear().diagonal() << 1, -1, -1;
  return flip;
}

void makeRightHanded(ViewHeader& header) {
  auto& camera = std::get<Pinhole>(header.projection);
  if (camera.fy >= 0) return;
  camera.fy = -camera.fy;
  const Eigen::Vector3d flip(1, -1, 1);
  header.world_from_camera.linear() =
      flip.asDiagonal() * header.world_from_camera.linear() * flip.asDiagonal();
  header.world_from_camera.translation().y() *= -1;
}

DepthSet setOfFrames(const fs::path& input, std::vector<Frame> frames, const FrameFormat& format,
                     const ReadOptions& options) {
  if (frames.empty()) throw IoError(input, "", "a view with a depth map", "none");
  DepthSet set;
  std::vector<ViewHeader> headers;
  for (Frame& frame : frames) {
    const RasterHeader depth = depthHeader(frame);
    checkConfidence(frame, depth);
    auto& camera = std::get<Pinhole>(frame.header.projection);
    camera = cameraFor(camera, depth, options);
    if (const auto problems = validate(frame.header.projection); !problems.empty())
      throw IoError(input, "view " + frame.header.name, "a usable camera", problems.front());
    if (headers.empty()) {
      const DepthEncoding encoding =
          encodingFor(options, frame.header.projection, format.kind, scaleOf(format, depth));
      set.reading = {depth.text(), encoding.kind, encoding.scale, invalidText(depth), format.pose};
    }
    headers.push_back(frame.header);
  }
  if (!format.stored_from_camera.matrix().isIdentity())
    set.stored_from_camera.assign(frames.size(), format.stored_from_camera);
  addNotes(frames, set.notes);
  auto source = std::make_shared<Source>(Source{std::move(frames), format, options});
  set.views =
      ViewSequence(std::move(headers), [source](std::size_t index) { return loadFrame(*source, index); });
  return set;
}

}  // namespace vdbfuse
