// SPDX-License-Identifier: Apache-2.0
#include "formats/bundler.h"

#include <algorithm>
#include <limits>

#include "formats/camera_text.h"
#include "formats/frames.h"
#include "formats/image_writer.h"
#include "formats/photo_files.h"
#include "formats/photo_writer.h"
#include "formats/sparse_depths.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_cursor.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kTitle = "# Bundle file v0.3";
constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();

// Empty: none.
fs::path bundleAt(const fs::path& path) {
  if (isFile(path)) return io::readFileStart(path, kTitle.size()) == kTitle ? path : fs::path();
  for (const char* name : {"bundle.out", "bundle/bundle.out"}) {
    if (isFile(path / name)) return path / name;
  }
  return {};
}

fs::path listOf(const fs::path& bundle) {
  const fs::path beside = bundle.parent_path() / "list.txt";
  const fs::path above = bundle.parent_path() / "../list.txt";
  return !isFile(beside) && isFile(above) ? above : beside;
}

struct Camera {
  Lens lens;  ///< fx is 0 where it was not found
  RigidTransform camera_from_world = RigidTransform::Identity();
};

Camera readCamera(const fs::path& file, io::TextCursor& text) {
  Camera camera;
  Pinhole& pinhole = camera.lens.camera;
  pinhole.fx = pinhole.fy = text.finite();
  for (std::size_t i = 0; i < 2; ++i) pinhole.distortion[i] = text.finite();
  Eigen::Matrix<double, 3, 4> pose;
  const std::string place = text.place();
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 3; ++column) pose(row, column) = text.finite();
  for (Eigen::Index row = 0; row < 3; ++row) pose(row, 3) = text.finite();
  if (pinhole.fx != 0) camera.camera_from_world = openGlFromCamera() * poseFromMatrix(file, place, pose);
  return camera;
}

void readPoints(io::TextCursor& text, std::int64_t count, std::int64_t cameras, SparseDepths& depths) {
  for (; count > 0; --count) {
    Eigen::Vector3d position;
    for (double& x : position) x = text.finite();
    for (int i = 0; i < 3; ++i) text.finite();
    for (std::int64_t seen = text.whole(kMost); seen > 0; --seen) {
      depths.add(static_cast<std::size_t>(text.whole(cameras - 1)), position);
      for (int i = 0; i < 3; ++i) text.finite();
    }
  }
}

fs::path pictureOf(const fs::path& list, const TextLine& line) {
  const fs::path folder = list.parent_path();
  const std::string place = "line " + std::to_string(line.number);
  const fs::path stated = pathInside(folder, line.words[0], list, place);
  const fs::path inside = pathInside(folder / "images", line.words[0], list, place);
  return !isFile(stated) && isFile(inside) ? inside : stated;
}

std::vector<TextLine> readList(const fs::path& list, std::size_t count) {
  if (!isFile(list)) throw IoError(list, "", "a list of the pictures", "nothing of that name");
  constexpr std::size_t kMostBytes = 64 << 20;
  std::vector<TextLine> lines = readTextLines(list, kMostBytes);
  if (lines.size() != count)
    throw IoError(list, linePlace(lines, std::min(count, lines.size())),
                  counted(count, "picture") + ", as there are cameras", std::to_string(lines.size()));
  return lines;
}

Detection detect(const fs::path& path) {
  using Fit = Detection::Fit;
  const fs::path bundle = bundleAt(path);
  if (bundle.empty()) return {Fit::No, "no bundle.out"};
  if (!isFile(listOf(bundle))) return {Fit::Partly, "bundle.out, but no list.txt"};
  return {Fit::Fully, "bundle.out and list.txt"};
}

}  // namespace

ImageSet readBundler(const fs::path& path, const ImageReadOptions& options) {
  const fs::path file = bundleAt(path);
  if (file.empty()) throw IoError(path, "", "bundle.out of Bundler", "none");
  const std::string bytes = io::readFileBytes(file);
  io::TextCursor text(file, bytes);
  if (const std::string_view title = text.restOfLine(); title != kTitle)
    text.fail("'" + std::string(kTitle) + "'", title);
  const std::int64_t camera_count = text.whole(kMost), point_count = text.whole(kMost);
  std::vector<Camera> cameras;
  std::vector<RigidTransform> poses;
  for (std::int64_t i = 0; i < camera_count; ++i) {
    cameras.push_back(readCamera(file, text));
    poses.push_back(cameras.back().camera_from_world);
  }
  SparseDepths depths(poses);
  readPoints(text, point_count, camera_count, depths);
  const fs::path list = listOf(file);
  const std::vector<TextLine> names = readList(list, cameras.size());
  std::vector<PhotoFile> photos;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].lens.camera.fx == 0) continue;
    const fs::path picture = pictureOf(list, names[i]);
    photos.push_back(
        {picture.stem().string(), cameras[i].lens, poses[i].inverse(), depths.interval(i), picture});
    photos.back().is_centred = true;
  }
  const std::size_t lost = cameras.size() - photos.size();
  ImageSet set = imageSetOf(path, std::move(photos), options);
  if (lost > 0) set.notes.push_back(counted(lost, "photograph") + " without a camera left out");
  set.pose = "3x3 and 3 camera_from_world, x right, y up, z backward";
  return set;
}

void writeBundler(const fs::path& folder, const PhotographSequence& photographs, const ImageWriteOptions&,
                  const Progress& progress) {
  std::string cameras, list;
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    const RigidTransform pose = openGlFromCamera() * photographs.header(i).world_from_camera.inverse();
    cameras += exactText(onlyFocalLength(photographs.header(i), "bundler")) + " 0 0\n" +
               matrixText(pose.linear()) + matrixText(pose.translation().transpose());
  }
  for (const std::string& name : writePictures(folder, "images", photographs, progress))
    list += "images/" + name + ".png\n";
  io::writeFileBytes(folder / "list.txt", list);
  io::writeFileBytes(folder / "bundle.out",
                     std::string(kTitle) + "\n" + std::to_string(photographs.size()) + " 0\n" + cameras);
}

ImageSetFormat bundlerImageFormat() {
  return {"bundler",
          "photographs with cameras of Bundler",
          "bundle.out (or bundle/bundle.out)   cameras, points\n"
          "list.txt                            a picture a line, in the order of the cameras\n"
          "the pictures                        where list.txt says, or in images/\n",
          detect,
          readBundler,
          writeBundler};
}

}  // namespace vdbfuse
