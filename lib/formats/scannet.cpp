// SPDX-License-Identifier: Apache-2.0
#include "formats/scannet.h"

#include <algorithm>
#include <array>

#include "formats/camera_text.h"
#include "formats/frames.h"
#include "formats/stored_depth.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

fs::path poseFolder(const fs::path& folder) {
  return fs::is_directory(folder / "pose") ? folder / "pose" : folder / "poses";
}

// The file of that name, in intrinsic/ or beside the images.
fs::path calibrationFile(const fs::path& folder, const std::string& name) {
  for (const fs::path& place : {folder / "intrinsic" / name, folder / name}) {
    if (fs::is_regular_file(place)) return place;
  }
  return {};
}

fs::path intrinsicsFile(const fs::path& folder) {
  const fs::path usual = calibrationFile(folder, "intrinsic_depth.txt");
  if (!usual.empty()) return usual;
  for (const std::string& name : filesEndingWith(folder, ".txt")) {
    if (name.find("intrinsic") != std::string::npos && name.find("color") == std::string::npos)
      return folder / name;
  }
  return {};
}

// The upper left 3×3 of the file's matrix.
Pinhole readCamera(const fs::path& path, int width, int height) {
  const std::vector<TextLine> lines = readTextLines(path);
  const int side = lines.size() == 3 ? 3 : 4;
  const Eigen::MatrixXd matrix = readMatrix(path, lines, 0, side, side, "a 4x4 or 3x3 matrix of intrinsics");
  return pinholeFromMatrix(path, linePlace(lines, 0), matrix.topLeftCorner(3, 3), width, height);
}

RigidTransform readTransform(const fs::path& path) {
  const std::vector<TextLine> lines = readTextLines(path);
  return poseFromMatrix(path, linePlace(lines, 0), readMatrix(path, lines, 0, 4, 4, "a 4x4 matrix"));
}

// Nothing where the tracker had lost the camera and wrote infinities.
std::optional<RigidTransform> readPose(const fs::path& path) {
  if (!fs::exists(path))
    throw IoError(path, "", "the pose of depth/" + path.stem().string() + ".png", "nothing of that name");
  const std::vector<TextLine> lines = readTextLines(path);
  const auto lost = [](const std::string& word) {
    return word.find("inf") != word.npos || word.find("nan") != word.npos;
  };
  for (const TextLine& line : lines) {
    if (std::all_of(line.words.begin(), line.words.end(), lost)) return std::nullopt;
  }
  return poseFromMatrix(path, linePlace(lines, 0), readMatrix(path, lines, 0, 4, 4, "a 4x4 pose matrix"));
}

std::vector<std::string> depthNames(const fs::path& folder) {
  constexpr std::array kExtensions = {".png", ".exr", ".npy", ".pfm", ".tiff"};
  return filesInOrder(folder / "depth", kExtensions);
}

// Cameras of depth and pictures that all frames share.
struct Cameras {
  Pinhole depth;
  fs::path color_intrinsics;  // empty: pictures are taken as the depth camera's
  RigidTransform depth_from_color = RigidTransform::Identity();
};

Cameras readCameras(const fs::path& folder, const ReadOptions& options) {
  Cameras cameras;
  const fs::path intrinsics = intrinsicsFile(folder);
  if (intrinsics.empty() && !options.intrinsics)
    throw IoError(folder, "", "intrinsic/intrinsic_depth.txt, or --intrinsics", "none");
  if (!options.intrinsics) cameras.depth = readCamera(intrinsics, 0, 0);
  cameras.color_intrinsics = calibrationFile(folder, "intrinsic_color.txt");
  const fs::path extrinsics = calibrationFile(folder, "extrinsic_color.txt");
  if (!extrinsics.empty()) cameras.depth_from_color = readTransform(extrinsics);
  return cameras;
}

void addPicture(const fs::path& folder, const Cameras& cameras, Frame& frame) {
  frame.color = findPicture(folder / "color", frame.header.name);
  if (frame.color.empty() || cameras.color_intrinsics.empty()) return;
  const auto [width, height] = pictureSize(frame.color);
  frame.header.color_sensor = ColorSensor{readCamera(cameras.color_intrinsics, width, height),
                                          frame.header.world_from_camera * cameras.depth_from_color};
}

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const std::size_t depths = depthNames(path).size(),
                    poses = filesEndingWith(poseFolder(path), ".txt").size();
  if (depths == 0 || poses == 0) return {Detection::Fit::No, "no depth/*.png with pose/*.txt"};
  if (intrinsicsFile(path).empty())
    return {Detection::Fit::Partly, "depth/ and pose/, but no intrinsic/intrinsic_depth.txt"};
  return {Detection::Fit::Fully, counted(depths, "depth map") + " with poses and intrinsics"};
}

DepthSet read(const fs::path& path, const ReadOptions& options) {
  const Cameras cameras = readCameras(path, options);
  std::vector<Frame> frames;
  std::size_t lost = 0;
  for (const std::string& name : depthNames(path)) {
    Frame frame;
    frame.header.name = fs::path(name).stem().string();
    const auto pose = readPose(poseFolder(path) / (frame.header.name + ".txt"));
    lost += pose ? 0 : 1;
    if (!pose) continue;
    frame.header.projection = cameras.depth;
    frame.header.world_from_camera = *pose;
    frame.depth = path / "depth" / name;
    addPicture(path, cameras, frame);
    frames.push_back(std::move(frame));
  }
  if (frames.empty() && lost > 0)
    throw IoError(path, "", "a finite pose", counted(lost, "pose") + " that are none");
  DepthSet set = setOfFrames(path, std::move(frames), {}, options);
  if (lost > 0) set.notes.push_back(counted(lost, "frame") + " whose pose is not finite left out");
  return set;
}

}  // namespace

DepthSetFormat scannetFormat() {
  return {"scannet", "scenes as the exporter of ScanNet writes them",
          "depth/0.png                     16 bit, millimetres (--depth-scale 0.001), z, 0 invalid\n"
          "pose/0.txt                      4x4 world_from_camera; infinite: left out\n"
          "intrinsic/intrinsic_depth.txt   4x4 or 3x3, for all frames\n"
          "color/0.jpg                     optional; camera in intrinsic/intrinsic_color.txt\n",
          detect, read};
}

}  // namespace vdbfuse
