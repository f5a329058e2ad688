// SPDX-License-Identifier: Apache-2.0
#include "formats/rgbd_folder.h"

#include <algorithm>
#include <array>

#include "formats/camera_text.h"
#include "formats/frames.h"
#include "formats/image_writer.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse {
namespace {

constexpr std::string_view kDepthMark = ".depth.";
constexpr std::array kDepthSuffixes = {".depth.png", ".depth.exr", ".depth.npy", ".depth.pfm", ".depth.tiff"};
constexpr std::string_view kPoseSuffix = ".pose.txt";
constexpr double kMetresPerMillimetre = 0.001;

std::vector<std::string> depthFiles(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const char* suffix : kDepthSuffixes) {
    const std::vector<std::string> found = filesEndingWith(folder, suffix);
    names.insert(names.end(), found.begin(), found.end());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> intrinsicsFiles(const std::filesystem::path& folder) {
  std::vector<std::string> names = filesEndingWith(folder, ".txt");
  std::erase_if(names, [](const std::string& name) { return name.find("intrinsics") == std::string::npos; });
  return names;
}

Pinhole readCamera(const std::filesystem::path& folder, const ReadOptions& options) {
  const std::vector<std::string> files = intrinsicsFiles(folder);
  if (options.intrinsics) return {};
  if (files.empty())
    throw IoError(folder, "", "an intrinsics file (*intrinsics*.txt), or --intrinsics", "none");
  if (files.size() > 1)
    throw IoError(folder, "", "one intrinsics file (*intrinsics*.txt)", files[0] + " and " + files[1]);
  const std::filesystem::path path = folder / files.front();
  const std::vector<TextLine> lines = readTextLines(path);
  return pinholeFromMatrix(path, linePlace(lines, 0),
                           readMatrix(path, lines, 0, 3, 3, "a 3x3 matrix of intrinsics"), 0, 0);
}

Detection detect(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const std::size_t depths = depthFiles(path).size();
  if (depths == 0) return {Detection::Fit::No, "no *.depth.png"};
  if (filesEndingWith(path, kPoseSuffix).empty())
    return {Detection::Fit::Partly, "*.depth.png, but no *.pose.txt"};
  if (intrinsicsFiles(path).empty()) return {Detection::Fit::Partly, "*.depth.png, but no *intrinsics*.txt"};
  return {Detection::Fit::Fully, counted(depths, "depth map") + " with poses and intrinsics"};
}

void write(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions& options,
           const Progress& progress) {
  const Pinhole camera = commonPinhole(views, "rgbd");
  io::writeFileBytes(folder / "intrinsics.txt", matrixText(intrinsicMatrix(camera)));
  const double scale = options.depth_scale.value_or(kMetresPerMillimetre);
  forEachView(views, progress, [&](const View& view, const std::string& name) {
    writeDepthPng(folder / (name + ".depth.png"), view, scale);
    io::writeFileBytes(folder / (name + std::string(kPoseSuffix)),
                       matrixText(view.world_from_camera.matrix()));
    writeColor(folder / (name + ".color.png"), view);
  });
}

}  // namespace

DepthSet readRgbdFolder(const std::filesystem::path& path, const ReadOptions& options) {
  if (!std::filesystem::is_directory(path)) throw IoError(path, "", "a folder", "a file");
  const std::vector<std::string> files = depthFiles(path);
  if (files.empty()) throw IoError(path, "", "depth maps (*.depth.png)", "none");
  const Pinhole camera = readCamera(path, options);
  std::vector<Frame> frames;
  for (const std::string& file : files) {
    Frame frame;
    frame.header.name = file.substr(0, file.rfind(kDepthMark));
    frame.header.projection = camera;
    frame.header.world_from_camera =
        readPoseFile(path / (frame.header.name + std::string(kPoseSuffix)), "the pose of " + file);
    frame.depth = path / file;
    frame.color = findPicture(path, frame.header.name + ".color");
    frames.push_back(std::move(frame));
  }
  DepthSet set = setOfFrames(path, std::move(frames), {}, options);
  const std::size_t poses = filesEndingWith(path, kPoseSuffix).size();
  if (poses > files.size())
    set.notes.push_back(counted(poses - files.size(), "pose") + " without a depth map left out");
  return set;
}

DepthSetFormat rgbdFormat() {
  return {"rgbd",
          "frames of a depth camera in one folder (7-Scenes and many recorders)",
          "NAME.depth.png         16-bit grey, millimetres (--depth-scale 0.001), 0 and 65535 invalid;\n"
          "                       or .exr, .npy, .pfm, .tiff, metres where it holds floats\n"
          "NAME.pose.txt          4x4 or 3x4 matrix world_from_camera\n"
          "NAME.color.png|jpg     optional\n"
          "NAME.mask.png          optional, 8 bit, black where the object is not; or masks/NAME.png\n"
          "*intrinsics*.txt       3x3 matrix, the same for all frames; or --intrinsics fx,fy,cx,cy\n",
          detect,
          readRgbdFolder,
          write};
}

}  // namespace vdbfuse
