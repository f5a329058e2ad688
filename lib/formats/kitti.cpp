// SPDX-License-Identifier: Apache-2.0
#include "formats/kitti.h"

#include <bit>
#include <memory>
#include <optional>

#include "formats/camera_text.h"
#include "formats/point_views.h"
#include "formats/scan_grid.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/line_stream.h"
#include "io/text_cursor.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".bin";
constexpr std::size_t kPointBytes = 16;

// The names of the sweeps, without their suffix, and where they lie.
struct Sweeps {
  fs::path folder;
  std::vector<std::string> names;
};

Sweeps sweepsAt(const fs::path& path) {
  for (const fs::path& folder : {path / "velodyne", path / "velodyne_points" / "data", path}) {
    Sweeps sweeps{folder, filesEndingWith(folder, kSuffix)};
    for (std::string& name : sweeps.names) name.resize(name.size() - kSuffix.size());
    if (!sweeps.names.empty()) return sweeps;
  }
  return {};
}

// poses.txt, or where KITTI keeps it; empty: none.
fs::path poseFile(const fs::path& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error).lexically_normal();
  const fs::path folder = whole.has_filename() ? whole : whole.parent_path();
  const fs::path distant =
      folder.parent_path().parent_path() / "poses" / (folder.filename().string() + ".txt");
  for (const fs::path& file : {path / "poses.txt", distant}) {
    if (fs::is_regular_file(file, error)) return file;
  }
  return {};
}

bool hasPoses(const fs::path& path) {
  return !filesEndingWith(path / "poses", ".txt").empty() || !poseFile(path).empty();
}

// Twelve numbers that are left of a line, as a 3×4 matrix.
RigidTransform takePose(const fs::path& path, const io::LineStream& line, std::string_view rest) {
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> matrix;
  for (double& value : matrix.reshaped<Eigen::RowMajor>()) value = io::takeNumber(rest);
  if (!matrix.allFinite() || rest.find_first_not_of(" \t") != rest.npos)
    throw IoError(path, line.place(), "the 12 numbers of a 3x4 matrix",
                  "'" + std::string(line.text().substr(0, 40)) + "'");
  return poseFromMatrix(path, line.place(), matrix);
}

std::vector<RigidTransform> readPoses(const fs::path& path) {
  std::vector<RigidTransform> poses;
  for (io::LineStream line(path); line.next();) {
    if (line.text().find_first_not_of(" \t") != line.text().npos)
      poses.push_back(takePose(path, line, line.text()));
  }
  return poses;
}

RigidTransform readPose(const fs::path& path, const std::string& sweep) {
  if (!fs::exists(path)) throw IoError(path, "", "the pose of " + sweep + ".bin", "nothing of that name");
  const std::vector<TextLine> lines = readTextLines(path);
  if (lines.size() == 1) return readPoses(path).front();
  return poseFromMatrix(path, linePlace(lines, 0),
                        readMatrix(path, lines, 0, lines.size() == 3 ? 3 : 4, 4, "a 3x4 or 4x4 pose matrix"));
}

// camera0_from_lidar; the identity when there is no calibration.
RigidTransform calibration(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return RigidTransform::Identity();
  for (io::LineStream line(path); line.next();) {
    for (const std::string_view key : {"Tr:", "Tr_velo_to_cam:"}) {
      if (line.text().starts_with(key)) return takePose(path, line, line.text().substr(key.size()));
    }
  }
  throw IoError(path, "", "a line Tr: with 12 numbers", "none");
}

// The line of a sweep among more lines than sweeps.
std::size_t lineOf(const fs::path& poses, const std::string& sweep, std::size_t lines) {
  const auto number = io::parseInteger(sweep);
  if (!number || *number < 0 || static_cast<std::uint64_t>(*number) >= lines)
    throw IoError(poses, "", "a line for the sweep " + sweep + ".bin", counted(lines, "line"));
  return static_cast<std::size_t>(*number);
}

std::vector<RigidTransform> posesOf(const fs::path& path, const Sweeps& sweeps) {
  std::vector<RigidTransform> result;
  if (!filesEndingWith(path / "poses", ".txt").empty()) {
    for (const std::string& name : sweeps.names)
      result.push_back(readPose(path / "poses" / (name + ".txt"), name));
    return result;
  }
  const fs::path file = poseFile(path);
  if (file.empty()) throw IoError(path, "", "poses.txt or poses/*.txt", "none");
  std::vector<RigidTransform> poses = readPoses(file);
  if (poses.size() == sweeps.names.size()) return poses;
  for (const std::string& name : sweeps.names) result.push_back(poses[lineOf(file, name, poses.size())]);
  return result;
}

float singleAt(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;) word = word << 8 | static_cast<unsigned char>(bytes[at + i]);
  return std::bit_cast<float>(word);
}

PointScan readSweep(const fs::path& path) {
  const std::string bytes = io::readFileBytes(path);
  if (bytes.size() % kPointBytes != 0)
    throw IoError(path, "byte " + std::to_string(bytes.size() / kPointBytes * kPointBytes),
                  "points of 16 bytes (x y z intensity)", "the end of the file");
  PointScan scan;
  scan.loose.reserve(bytes.size() / kPointBytes);
  for (std::size_t at = 0; at < bytes.size(); at += kPointBytes) {
    const Eigen::Vector3d p(singleAt(bytes, at), singleAt(bytes, at + 4), singleAt(bytes, at + 8));
    const Eigen::Vector3f point = scannedPoint({-p.y(), -p.z(), p.x()});
    if (point.allFinite()) scan.loose.push_back(point);
  }
  return scan;
}

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const Sweeps sweeps = sweepsAt(path);
  if (sweeps.names.empty()) return {Detection::Fit::No, "no velodyne/*.bin"};
  if (hasPoses(path)) return {Detection::Fit::Fully, counted(sweeps.names.size(), "sweep") + " with poses"};
  // Many formats have *.bin files.
  if (sweeps.folder == path) return {Detection::Fit::No, "*.bin, but no poses.txt"};
  return {Detection::Fit::Partly, "sweeps, but no poses.txt and no poses/*.txt"};
}

}  // namespace

DepthSet readKitti(const fs::path& path, const ReadOptions& options) {
  if (!fs::is_directory(path)) throw IoError(path, "", "a folder", "a file");
  auto sweeps = std::make_shared<const Sweeps>(sweepsAt(path));
  if (sweeps->names.empty()) throw IoError(path, "", "sweeps (velodyne/*.bin)", "none");
  const std::vector<RigidTransform> poses = posesOf(path, *sweeps);
  const RigidTransform camera0_from_view = calibration(path / "calib.txt") * cameraFromScanner().inverse();
  ScanSource source;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ViewHeader header;
    header.name = sweeps->names[i];
    header.world_from_camera = poses[i] * camera0_from_view;
    source.headers.push_back(std::move(header));
  }
  source.sensors = ScanSource::Sensors::OneForAll;
  source.stored_from_camera.assign(poses.size(), camera0_from_view);
  source.load = [sweeps](std::size_t index) {
    return readSweep(sweeps->folder / (sweeps->names[index] + std::string(kSuffix)));
  };
  source.stored = "x y z as 4-byte floats";
  source.invalid = "0 0 0, not finite";
  source.pose = fs::exists(path / "calib.txt")
                    ? "3x4 world_from_camera0, with camera0_from_lidar of calib.txt"
                    : "3x4 world_from_lidar, x forward, y left, z up";
  return setOfScans(path, std::move(source), options, "kitti");
}

DepthSetFormat kittiFormat() {
  return {"kitti", "sweeps of a turning laser with poses (KITTI odometry)",
          "velodyne/NAME.bin   4-byte floats x y z intensity; or velodyne_points/data/NAME.bin, NAME.bin\n"
          "calib.txt           optional, \"Tr:\" and 3x4 camera0_from_lidar\n"
          "poses.txt           12 numbers a line, 3x4 world_from_camera0 (world_from_lidar without\n"
          "                    calib.txt); or poses/NAME.txt, a matrix each\n",
          detect, readKitti};
}

}  // namespace vdbfuse
