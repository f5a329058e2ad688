// SPDX-License-Identifier: Apache-2.0
#include "formats/nvm.h"

#include <algorithm>
#include <limits>

#include "formats/camera_text.h"
#include "formats/image_writer.h"
#include "formats/photo_files.h"
#include "formats/photo_writer.h"
#include "formats/sparse_depths.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = ".nvm", kTitle = "NVM_V3";
constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();

std::vector<std::string> filesAt(const fs::path& path) {
  if (fs::is_directory(path)) return filesEndingWith(path, kSuffix);
  return path.extension() == kSuffix ? std::vector{path.filename().string()} : std::vector<std::string>();
}

// The camera of all photographs where the first line has one.
std::optional<Pinhole> readTitle(io::TextCursor& text) {
  if (const std::string_view title = text.word(); title != kTitle)
    text.fail("'" + std::string(kTitle) + "'", title);
  std::optional<Pinhole> fixed;
  if (text.wordOnLine() == "FixedK") {
    fixed.emplace();
    fixed->fx = text.finite(), fixed->cx = text.finite() - 0.5;
    fixed->fy = text.finite(), fixed->cy = text.finite() - 0.5;
  }
  text.restOfLine();
  return fixed;
}

PhotoFile readCamera(const fs::path& file, io::TextCursor& text, const std::optional<Pinhole>& fixed) {
  std::string name(text.word());
  if (name.empty()) text.fail("the name of a picture", name);
  std::replace(name.begin(), name.end(), '"', ' ');
  const std::string place = text.place();
  PhotoFile photo;
  photo.picture = pathInside(file.parent_path(), name, file, place);
  photo.name = photo.picture.stem().string();
  double v[9];  // f, quaternion, centre, k
  for (double& value : v) value = text.finite();
  text.finite();
  photo.lens.camera.fx = photo.lens.camera.fy = v[0];
  if (fixed) photo.lens.camera = *fixed;
  photo.is_centred = !fixed;
  photo.lens.measured_radial = v[8];
  photo.world_from_camera = poseFromQuaternion(file, place, {v[5], v[6], v[7]},
                                               Eigen::Quaterniond(v[1], v[2], v[3], v[4]).conjugate());
  return photo;
}

void readPoints(io::TextCursor& text, std::vector<PhotoFile>& photos) {
  std::vector<RigidTransform> poses;
  for (const PhotoFile& photo : photos) poses.push_back(photo.world_from_camera.inverse());
  SparseDepths depths(poses);
  for (std::int64_t count = text.whole(kMost); count > 0; --count) {
    Eigen::Vector3d position;
    for (double& x : position) x = text.finite();
    for (int i = 0; i < 3; ++i) text.finite();
    for (std::int64_t seen = text.whole(kMost); seen > 0; --seen) {
      depths.add(static_cast<std::size_t>(text.whole(static_cast<std::int64_t>(poses.size()) - 1)), position);
      for (int i = 0; i < 3; ++i) text.finite();
    }
  }
  for (std::size_t i = 0; i < photos.size(); ++i) photos[i].depth = depths.interval(i);
}

Detection detect(const fs::path& path) {
  using Fit = Detection::Fit;
  const std::vector<std::string> files = filesAt(path);
  if (files.empty()) return {Fit::No, "no *.nvm"};
  if (files.size() > 1) return {Fit::Partly, counted(files.size(), "file") + " *.nvm"};
  return {Fit::Fully, files.front()};
}

}  // namespace

ImageSet readNvm(const fs::path& path, const ImageReadOptions& options) {
  const std::vector<std::string> files = filesAt(path);
  if (files.size() != 1)
    throw IoError(path, "", "one file *.nvm", files.empty() ? "none" : std::to_string(files.size()));
  const fs::path file = fs::is_directory(path) ? path / files.front() : path;
  const std::string bytes = io::readFileBytes(file);
  io::TextCursor text(file, bytes);
  const std::optional<Pinhole> fixed = readTitle(text);
  std::vector<PhotoFile> photos;
  for (std::int64_t count = text.whole(kMost); count > 0; --count)
    photos.push_back(readCamera(file, text, fixed));
  if (photos.empty()) text.failWith("at least one camera", "none");
  readPoints(text, photos);
  const std::string_view next = text.word();
  ImageSet set = imageSetOf(path, std::move(photos), options);
  if (!next.empty() && next != "0" && !next.starts_with('#'))
    set.notes.emplace_back("models after the first left out");
  set.pose = "quaternion w x y z camera_from_world and the centre, x right, y down, z forward";
  return set;
}

void writeNvm(const fs::path& folder, const PhotographSequence& photographs, const ImageWriteOptions&,
              const Progress& progress) {
  std::vector<std::string> cameras;
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    const PhotographHeader& header = photographs.header(i);
    const Eigen::Quaterniond q(Eigen::Matrix3d(header.world_from_camera.linear().transpose()));
    const Eigen::Vector3d c = header.world_from_camera.translation();
    cameras.push_back(
        numbersText({onlyFocalLength(header, "nvm"), q.w(), q.x(), q.y(), q.z(), c.x(), c.y(), c.z(), 0, 0}));
  }
  const std::vector<std::string> names = writePictures(folder, "images", photographs, progress);
  std::string text = std::string(kTitle) + "\n\n" + std::to_string(names.size()) + "\n";
  for (std::size_t i = 0; i < names.size(); ++i) text += "images/" + names[i] + ".png" + cameras[i] + "\n";
  io::writeFileBytes(folder / "photographs.nvm", text + "\n0\n");
}

ImageSetFormat nvmImageFormat() {
  return {"nvm",
          "photographs with cameras of VisualSFM",
          "NAME.nvm         NVM_V3; cameras, points\n"
          "the pictures     where it says\n",
          detect,
          readNvm,
          writeNvm};
}

}  // namespace vdbfuse
