// SPDX-License-Identifier: Apache-2.0
#include "formats/strecha.h"

#include <array>
#include <cmath>

#include "formats/camera_text.h"
#include "formats/image_writer.h"
#include "formats/photo_files.h"
#include "formats/photo_writer.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = ".camera";
constexpr double kLargestSide = 1 << 20;

// Where the camera files are, and their names.
struct CameraFiles {
  fs::path folder;
  std::vector<std::string> names;
};

CameraFiles cameraFilesAt(const fs::path& path) {
  constexpr std::array kSuffixes = {kSuffix.data()};
  for (const fs::path& folder : {path, path / "cameras"}) {
    CameraFiles files{folder, filesInOrder(folder, kSuffixes)};
    if (!files.names.empty()) return files;
  }
  return {};
}

// Beside the camera file, or in images/.
fs::path pictureOf(const fs::path& path, const fs::path& folder, const std::string& name) {
  const fs::path beside = folder / name;
  return isFile(beside) ? beside : path / "images" / name;
}

int readSide(const fs::path& file, const TextLine& line, std::size_t index) {
  const double side = finiteNumber(file, line, line.words[index]);
  if (!(side >= 1 && side <= kLargestSide && side == std::floor(side)))
    throw IoError(file, "line " + std::to_string(line.number), "a size of 1 to 1048576 pixels",
                  numberText(side));
  return static_cast<int>(side);
}

PhotoFile readCamera(const fs::path& file) {
  const std::vector<TextLine> lines = readTextLines(file);
  const Eigen::MatrixXd intrinsics = readMatrix(file, lines, 0, 3, 3, "a 3x3 matrix of intrinsics");
  const Eigen::MatrixXd distortion = readMatrix(file, lines, 3, 1, 3, "three zeros (no distortion)");
  if (!distortion.isZero(0))
    throw IoError(file, linePlace(lines, 3), "three zeros (no distortion)", "other numbers");
  Eigen::Matrix<double, 3, 4> pose;
  pose.leftCols<3>() = readMatrix(file, lines, 4, 3, 3, "a 3x3 rotation, world_from_camera");
  pose.col(3) = readMatrix(file, lines, 7, 1, 3, "the centre of the camera").transpose();
  readMatrix(file, lines, 8, 1, 2, "width and height");
  PhotoFile photo;
  photo.lens.camera = pinholeFromMatrix(file, linePlace(lines, 0), intrinsics, readSide(file, lines[8], 0),
                                        readSide(file, lines[8], 1));
  photo.world_from_camera = poseFromMatrix(file, linePlace(lines, 4), pose);
  return photo;
}

Detection detect(const fs::path& path) {
  const CameraFiles files = cameraFilesAt(path);
  if (files.names.empty()) return {Detection::Fit::No, "no *.camera"};
  return {Detection::Fit::Fully, counted(files.names.size(), "camera file")};
}

}  // namespace

ImageSet readStrecha(const fs::path& path, const ImageReadOptions& options) {
  const CameraFiles files = cameraFilesAt(path);
  if (files.names.empty()) throw IoError(path, "", "camera files (PICTURE.camera)", "none");
  std::vector<PhotoFile> photos;
  for (const std::string& name : files.names) {
    PhotoFile photo = readCamera(files.folder / name);
    photo.picture = pictureOf(path, files.folder, name.substr(0, name.size() - kSuffix.size()));
    photo.name = photo.picture.stem().string();
    photos.push_back(std::move(photo));
  }
  ImageSet set = imageSetOf(path, std::move(photos), options);
  set.pose = "3x3 world_from_camera and the centre, x right, y down, z forward";
  return set;
}

void writeStrecha(const fs::path& folder, const PhotographSequence& photographs, const ImageWriteOptions&,
                  const Progress& progress) {
  const std::vector<std::string> names = writePictures(folder, "", photographs, progress);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PhotographHeader& header = photographs.header(i);
    const RigidTransform& pose = header.world_from_camera;
    io::writeFileBytes(folder / (names[i] + ".png.camera"),
                       matrixText(intrinsicMatrix(header.camera)) + "0 0 0\n" + matrixText(pose.linear()) +
                           matrixText(pose.translation().transpose()) + std::to_string(header.camera.width) +
                           " " + std::to_string(header.camera.height) + "\n");
  }
}

ImageSetFormat strechaImageFormat() {
  return {"strecha",
          "photographs with .camera files of Strecha et al.",
          "PICTURE.camera     K 3x3; 0 0 0; R 3x3 world_from_camera; centre; width and height\n"
          "PICTURE            beside it; or images/PICTURE and cameras/PICTURE.camera\n",
          detect,
          readStrecha,
          writeStrecha};
}

}  // namespace vdbfuse
