// SPDX-License-Identifier: Apache-2.0
#include "formats/arkit.h"

#include <algorithm>

#include "formats/camera_text.h"
#include "formats/frames.h"
#include "formats/json_fields.h"
#include "formats/stored_depth.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kJson = ".json", kFrame = "frame_";

fs::path keyframes(const fs::path& folder) {
  return fs::is_directory(folder / "keyframes") ? folder / "keyframes" : folder;
}

fs::path cameraFolder(const fs::path& folder) {
  const fs::path corrected = keyframes(folder) / "corrected_cameras";
  return filesEndingWith(corrected, kJson).empty() ? keyframes(folder) / "cameras" : corrected;
}

// Names of the frames of the app's layout: what stands between frame_ and .json.
std::vector<std::string> appFrames(const fs::path& folder) {
  std::vector<std::string> names;
  for (const std::string& file : filesEndingWith(folder, kJson)) {
    if (file.starts_with(kFrame) && file.size() > kFrame.size() + kJson.size())
      names.push_back(file.substr(kFrame.size(), file.size() - kFrame.size() - kJson.size()));
  }
  return names;
}

// Numbers of a matrix, row by row.
Eigen::MatrixXd matrixOf(const JsonField& field, int rows, int columns) {
  const Eigen::VectorXd numbers = field.numbers(static_cast<std::size_t>(rows * columns));
  return numbers.reshaped<Eigen::RowMajor>(rows, columns);
}

RigidTransform polycamPose(const fs::path& path, const JsonField& json) {
  Eigen::MatrixXd matrix(3, 4);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column)
      matrix(row, column) = json.at("t_" + std::to_string(row) + std::to_string(column)).number();
  }
  return poseFromMatrix(path, "t_00 to t_23", matrix);
}

Pinhole polycamCamera(const JsonField& json) {
  constexpr int kLargestSide = 65536;
  const auto number = [&](const char* key) { return json.at(key).number(); };
  return {json.at("width").whole(1, kLargestSide),
          json.at("height").whole(1, kLargestSide),
          number("fx"),
          number("fy"),
          number("cx"),
          number("cy"),
          {}};
}

fs::path ifThere(const fs::path& path) { return fs::is_regular_file(path) ? path : fs::path(); }

std::vector<Frame> polycamFrames(const fs::path& folder, std::size_t& without_depth) {
  const fs::path root = keyframes(folder), cameras = cameraFolder(folder);
  const bool is_corrected = cameras.filename() == "corrected_cameras";
  std::vector<Frame> frames;
  for (const std::string& file : filesEndingWith(cameras, kJson)) {
    const std::string name = file.substr(0, file.size() - kJson.size());
    const fs::path depth = ifThere(root / "depth" / (name + ".png"));
    without_depth += depth.empty() ? 1 : 0;
    if (depth.empty()) continue;
    const JsonField json = JsonField::readFile(cameras / file);
    Frame frame;
    frame.header = {name, polycamCamera(json), polycamPose(cameras / file, json) * openGlFromCamera()};
    frame.depth = depth;
    frame.confidence = ifThere(root / "confidence" / (name + ".png"));
    frame.color = findPicture(root / (is_corrected ? "corrected_images" : "images"), name);
    frames.push_back(std::move(frame));
  }
  return frames;
}

// All pictures of a capture have one size.
std::pair<int, int> appPictureSize(const fs::path& folder, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const fs::path picture = findPicture(folder, std::string(kFrame) + name);
    if (!picture.empty()) return pictureSize(picture);
  }
  throw IoError(folder, "", "a picture frame_N.jpg, whose size is that of the intrinsics", "none");
}

std::vector<Frame> appFramesOf(const fs::path& folder, std::size_t& without_depth) {
  const std::vector<std::string> names = appFrames(folder);
  const auto [width, height] = appPictureSize(folder, names);
  std::vector<Frame> frames;
  for (const std::string& name : names) {
    const fs::path depth = ifThere(folder / ("depth_" + name + ".png"));
    without_depth += depth.empty() ? 1 : 0;
    if (depth.empty()) continue;
    const fs::path path = folder / (std::string(kFrame) + name + ".json");
    const JsonField json = JsonField::readFile(path);
    Frame frame;
    frame.header.name = name;
    frame.header.projection =
        pinholeFromMatrix(path, "intrinsics", matrixOf(json.at("intrinsics"), 3, 3), width, height);
    frame.header.world_from_camera =
        poseFromMatrix(path, "cameraPoseARFrame", matrixOf(json.at("cameraPoseARFrame"), 4, 4)) *
        openGlFromCamera();
    frame.depth = depth;
    frame.confidence = ifThere(folder / ("conf_" + name + ".png"));
    frame.color = findPicture(folder, std::string(kFrame) + name);
    frames.push_back(std::move(frame));
  }
  return frames;
}

bool isPolycam(const fs::path& folder) { return !filesEndingWith(cameraFolder(folder), kJson).empty(); }

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const bool has_depth = isPolycam(path) ? !filesEndingWith(keyframes(path) / "depth", ".png").empty()
                                         : !appFrames(path).empty();
  if (!isPolycam(path) && !has_depth)
    return {Detection::Fit::No, "no keyframes/cameras/*.json and no frame_*.json"};
  if (!has_depth) return {Detection::Fit::Partly, "keyframes/cameras, but no keyframes/depth/*.png"};
  return {Detection::Fit::Fully, isPolycam(path) ? "cameras and depth of Polycam" : "frame_*.json"};
}

DepthSet read(const fs::path& path, const ReadOptions& options) {
  std::size_t without_depth = 0;
  std::vector<Frame> frames =
      isPolycam(path) ? polycamFrames(path, without_depth) : appFramesOf(path, without_depth);
  FrameFormat format;
  format.stored_from_camera = openGlFromCamera();
  format.pose = "4x4 world_from_camera, ARKit: x right, y up, z backward";
  DepthSet set = setOfFrames(path, std::move(frames), format, options);
  if (without_depth > 0)
    set.notes.push_back(counted(without_depth, "camera") + " without a depth map left out");
  return set;
}

}  // namespace

DepthSetFormat arkitFormat() {
  return {
      "arkit", "captures of phones with a laser: Polycam raw data, 3D Scanner App",
      "keyframes/cameras/NAME.json      Polycam: t_00..t_23 world_from_camera (x right, y up, z backward),\n"
      "                                 fx fy cx cy width height; corrected_cameras/ is preferred\n"
      "keyframes/depth/NAME.png         16 bit, millimetres (--depth-scale 0.001), z, 0 invalid\n"
      "keyframes/confidence/NAME.png    optional\n"
      "keyframes/images/NAME.jpg        optional\n"
      "or frame_N.json                  3D Scanner App: cameraPoseARFrame, intrinsics\n"
      "   depth_N.png, conf_N.png, frame_N.jpg\n",
      detect, read};
}

}  // namespace vdbfuse
