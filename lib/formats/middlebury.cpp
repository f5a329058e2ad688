// SPDX-License-Identifier: Apache-2.0
#include "formats/middlebury.h"

#include <algorithm>

#include "formats/camera_text.h"
#include "formats/image_writer.h"
#include "formats/photo_files.h"
#include "formats/photo_writer.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_cursor.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = "_par.txt";
constexpr std::size_t kNumbers = 9 + 9 + 3;

using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

std::vector<std::string> filesAt(const fs::path& path) {
  if (fs::is_directory(path)) return filesEndingWith(path, kSuffix);
  const std::string name = path.filename().string();
  return name.ends_with(kSuffix) ? std::vector{name} : std::vector<std::string>();
}

// How many photographs there are said to be, which must be how many there are.
void checkCount(const fs::path& file, const std::vector<TextLine>& lines) {
  const char* expected = "the number of photographs";
  if (lines.empty()) throw IoError(file, "line 1", expected, "the end of the file");
  const auto count = io::parseInteger(lines[0].words[0]);
  if (!count || *count < 1 || lines[0].words.size() > 1)
    throw IoError(file, linePlace(lines, 0), expected, "'" + lines[0].words[0].substr(0, 40) + "'");
  const auto said = static_cast<std::uint64_t>(*count);
  if (said != lines.size() - 1)
    throw IoError(file, linePlace(lines, std::min<std::uint64_t>(said + 1, lines.size())),
                  counted(said, "photograph"), std::to_string(lines.size() - 1));
}

PhotoFile photoOf(const fs::path& file, const TextLine& line) {
  const std::string place = "line " + std::to_string(line.number);
  if (line.words.size() != 1 + kNumbers)
    throw IoError(file, place, "the name of a picture and 21 numbers", counted(line.words.size(), "word"));
  double v[kNumbers];
  for (std::size_t i = 0; i < kNumbers; ++i) v[i] = finiteNumber(file, line, line.words[1 + i]);
  Eigen::Matrix<double, 3, 4> pose;
  pose << Eigen::Map<const Matrix3>(v + 9), Eigen::Map<const Eigen::Vector3d>(v + 18);
  PhotoFile photo;
  photo.picture = pathInside(file.parent_path(), line.words[0], file, place);
  photo.name = photo.picture.stem().string();
  photo.lens.camera = pinholeFromMatrix(file, place, Eigen::Map<const Matrix3>(v), 0, 0);
  photo.world_from_camera = poseFromMatrix(file, place, pose).inverse();
  return photo;
}

Detection detect(const fs::path& path) {
  const std::vector<std::string> files = filesAt(path);
  if (files.empty()) return {Detection::Fit::No, "no *_par.txt"};
  if (files.size() > 1) return {Detection::Fit::Partly, counted(files.size(), "file") + " *_par.txt"};
  return {Detection::Fit::Fully, files.front()};
}

}  // namespace

ImageSet readMiddlebury(const fs::path& path, const ImageReadOptions& options) {
  const std::vector<std::string> files = filesAt(path);
  if (files.size() != 1)
    throw IoError(path, "", "one file *_par.txt", files.empty() ? "none" : std::to_string(files.size()));
  const fs::path file = fs::is_directory(path) ? path / files.front() : path;
  const std::vector<TextLine> lines = readListing(file);
  checkCount(file, lines);
  std::vector<PhotoFile> photos;
  for (std::size_t i = 1; i < lines.size(); ++i) photos.push_back(photoOf(file, lines[i]));
  ImageSet set = imageSetOf(path, std::move(photos), options);
  set.pose = "3x3 and 3 camera_from_world, x right, y down, z forward";
  return set;
}

void writeMiddlebury(const fs::path& folder, const PhotographSequence& photographs, const ImageWriteOptions&,
                     const Progress& progress) {
  const std::vector<std::string> names = writePictures(folder, "", photographs, progress);
  std::string text = std::to_string(names.size()) + "\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Pinhole& c = photographs.header(i).camera;
    const RigidTransform pose = photographs.header(i).world_from_camera.inverse();
    const Eigen::Matrix3d r = pose.linear();
    const Eigen::Vector3d t = pose.translation();
    text += names[i] + ".png" + numbersText({c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1}) +
            numbersText({r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)}) +
            numbersText({t.x(), t.y(), t.z()}) + "\n";
  }
  io::writeFileBytes(folder / "photographs_par.txt", text);
}

ImageSetFormat middleburyImageFormat() {
  return {"middlebury",
          "photographs of the Middlebury multi-view stereo evaluation",
          "NAME_par.txt     the number of photographs; a line each: picture, K (9), R (9), t (3), "
          "camera_from_world\n"
          "PICTURE          beside it\n",
          detect,
          readMiddlebury,
          writeMiddlebury};
}

}  // namespace vdbfuse
