// SPDX-License-Identifier: Apache-2.0
#include "formats/sens.h"

#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>

#include "formats/camera_text.h"
#include "formats/sens_file.h"
#include "formats/stored_depth.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = ".sens";

struct Source {
  SensFile file;
  ReadOptions options;
  bool has_color = false;
};

fs::path fileAt(const fs::path& path) {
  if (!fs::is_directory(path)) return path;
  const std::vector<std::string> files = filesEndingWith(path, kSuffix);
  if (files.empty()) throw IoError(path, "", "a .sens file", "none");
  if (files.size() > 1) throw IoError(path, "", "one .sens file", files[0] + " and " + files[1]);
  return path / files.front();
}

Pinhole cameraOf(const fs::path& path, const SensCamera& stored) {
  const std::string place = "byte " + std::to_string(stored.intrinsics_byte);
  const Eigen::Matrix3d matrix = stored.intrinsics.topLeftCorner<3, 3>();
  if (!matrix.allFinite()) throw IoError(path, place, "finite intrinsics", "others");
  return pinholeFromMatrix(path, place, matrix, stored.width, stored.height);
}

Pinhole depthCamera(const SensFile& file, const ReadOptions& options) {
  if (!options.intrinsics) return cameraOf(file.path, file.depth);
  const auto& [fx, fy, cx, cy] = *options.intrinsics;
  return {file.depth.width, file.depth.height, fx, fy, cx, cy, {}};
}

// The colour camera as seen from the depth camera.
struct ColorRig {
  Pinhole camera;
  RigidTransform depth_from_color = RigidTransform::Identity();
};

std::optional<ColorRig> colorRig(const SensFile& file) {
  if (file.color.width == 0 || file.color_compression == SensColor::Other) return std::nullopt;
  try {
    return ColorRig{cameraOf(file.path, file.color), rigidFromMatrix(file.depth.extrinsics) *
                                                         rigidFromMatrix(file.color.extrinsics).inverse()};
  } catch (const Error&) {
    return std::nullopt;  // pictures that lie nowhere
  }
}

std::string frameName(std::size_t index) {
  std::ostringstream text;
  text << "frame-" << std::setw(6) << std::setfill('0') << index;
  return text.str();
}

ViewHeader headerOf(const SensFile& file, std::size_t index, const Pinhole& camera,
                    const std::optional<ColorRig>& rig) {
  const SensFrame& frame = file.frames[index];
  ViewHeader header;
  header.name = frameName(index);
  header.projection = camera;
  header.world_from_camera =
      poseFromMatrix(file.path, "byte " + std::to_string(frame.begin), frame.world_from_camera);
  const bool is_same =
      rig && rig->camera == camera && rig->depth_from_color.isApprox(RigidTransform::Identity(), 1e-9);
  if (rig && !is_same && frame.color_bytes > 0)
    header.color_sensor = ColorSensor{rig->camera, header.world_from_camera * rig->depth_from_color};
  return header;
}

DepthMap loadFrame(const Source& source, const SensFrame& frame, const Projection& projection) {
  DepthMap map;
  map.depth = sensorDepth(readSensDepth(source.file, frame), projection,
                          encodingFor(source.options, projection, DepthKind::Z, 1 / source.file.depth_shift),
                          source.options);
  if (source.has_color) map.color = readSensColor(source.file, frame);
  return map;
}

std::string compressionText(SensDepth compression) {
  return compression == SensDepth::Zlib ? "16-bit numbers, zlib" : "16-bit numbers";
}

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path))
    return path.extension() == kSuffix ? Detection{Detection::Fit::Fully, "a .sens file"}
                                       : Detection{Detection::Fit::No, "not a folder and no .sens file"};
  const std::size_t files = filesEndingWith(path, kSuffix).size();
  if (files == 0) return {Detection::Fit::No, "no *.sens"};
  return {files == 1 ? Detection::Fit::Fully : Detection::Fit::Partly, counted(files, ".sens file")};
}

// Those that have a pose.
std::vector<std::size_t> usableFrames(const SensFile& file) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < file.frames.size(); ++i) {
    if (file.frames[i].world_from_camera.allFinite()) usable.push_back(i);
  }
  if (usable.empty())
    throw IoError(file.path, "", "a frame with a pose", counted(file.frames.size(), "frame") + " without");
  return usable;
}

std::vector<std::string> notesOn(const SensFile& file, std::size_t usable, bool has_rig) {
  std::vector<std::string> notes;
  if (usable < file.frames.size())
    notes.push_back(counted(file.frames.size() - usable, "frame") + " without a pose left out");
  if (!has_rig && file.color.width > 0)
    notes.emplace_back("pictures left out: their camera or coding is not known");
  return notes;
}

}  // namespace

DepthSet readSens(const fs::path& path, const ReadOptions& options) {
  auto source = std::make_shared<Source>(Source{indexSens(fileAt(path)), options, false});
  const SensFile& file = source->file;
  const std::vector<std::size_t> frames = usableFrames(file);
  const Pinhole camera = depthCamera(file, options);
  const std::optional<ColorRig> rig = colorRig(file);
  source->has_color = rig && options.color == ReadOptions::Color::Load;
  std::vector<ViewHeader> headers;
  for (const std::size_t index : frames) headers.push_back(headerOf(file, index, camera, rig));
  DepthSet set;
  const DepthEncoding encoding = encodingFor(options, camera, DepthKind::Z, 1 / file.depth_shift);
  set.reading = {compressionText(file.depth_compression), encoding.kind, encoding.scale, "0 and 65535",
                 "4x4 world_from_camera, x right, y down, z forward"};
  set.notes = notesOn(file, frames.size(), rig.has_value());
  set.views = ViewSequence(std::move(headers), [source, camera, frames](std::size_t index) {
    return loadFrame(*source, source->file.frames[frames[index]], camera);
  });
  return set;
}

DepthSetFormat sensFormat() {
  return {"sens", "recordings of BundleFusion and ScanNet, version 4",
          "NAME.sens   one file with all frames: depth raw or zlib, colour raw, PNG or JPEG,\n"
          "            4x4 world_from_camera each; frames without a pose are left out\n",
          detect, readSens};
}

}  // namespace vdbfuse
