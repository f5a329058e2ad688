// SPDX-License-Identifier: Apache-2.0
#include "formats/points.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "formats/point_file.h"
#include "formats/point_views.h"
#include "formats/scan_poses.h"
#include "formats/sensor_groups.h"
#include "formats/stored_depth.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using Points = std::vector<Eigen::Vector3f>;

RigidTransform rotation(const Eigen::Matrix3d& matrix) {
  RigidTransform result = RigidTransform::Identity();
  result.linear() = matrix;
  return result;
}

// stored_from_camera, for points around the origin of axes with z up.
RigidTransform frameOf(const Points& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite() || p.isZero()) continue;
    sum += p.cast<double>().normalized();
    count += 1;
  }
  constexpr double kOneSided = 0.5, kSteep = 0.7;
  const double length = sum.norm();
  if (!(length > kOneSided * count) || std::abs(sum.z()) < kSteep * length)
    return cameraFromScanner().inverse();
  Eigen::Matrix3d axes;
  axes.col(2) = sum / length;
  axes.col(0) = axes.col(2).cross(Eigen::Vector3d::UnitX()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return rotation(axes);
}

PointScan turned(const Points& points, const RigidTransform& stored_from_camera) {
  const Eigen::Matrix3f camera_from_stored = stored_from_camera.linear().transpose().cast<float>();
  PointScan scan;
  for (const Eigen::Vector3f& p : points) scan.loose.emplace_back(camera_from_stored * p);
  return scan;
}

Points fromScanner(const fs::path& path) {
  Points points;
  for (const Eigen::Vector3d& p : readPoints(path)) points.emplace_back(p.cast<float>());
  return points;
}

std::vector<std::string> scansIn(const fs::path& folder) {
  std::vector<std::string> names = filesEndingWith(folder, "");
  std::erase_if(names, [](const std::string& name) { return !isPointFile(name); });
  return names;
}

DepthSet readFolder(const fs::path& folder, const ReadOptions& options) {
  const std::vector<std::string> files = scansIn(folder);
  if (files.empty()) throw IoError(folder, "", "scans (*.ply, *.xyz, *.pcd)", "none");
  const std::vector<RigidTransform> poses = readScanPoses(folder, files);
  ScanSource source;
  std::vector<RigidTransform> frames;
  for (std::size_t i = 0; i < files.size(); ++i) {
    frames.push_back(frameOf(fromScanner(folder / files[i])));
    source.headers.push_back(
        {fs::path(files[i]).stem().string(), {}, poses[i] * frames.back(), std::nullopt});
  }
  source.pose = "world_from_scan, scanner's axes: x forward, y left, z up";
  source.load = [folder, files, frames](std::size_t index) {
    return turned(fromScanner(folder / files[index]), frames[index]);
  };
  source.stored_from_camera = frames;
  return setOfScans(folder, std::move(source), options, "points");
}

SensorGroups groupsOf(const fs::path& path) {
  try {
    return groupBySensor(readSensedPoints(path));
  } catch (const InvalidArgument& error) {
    throw IoError(path, "", "points that sensors saw", error.what());
  }
}

DepthSet readFile(const fs::path& path, const ReadOptions& options) {
  const auto groups = std::make_shared<const SensorGroups>(groupsOf(path));
  ScanSource source;
  std::vector<RigidTransform> frames;
  for (const SensorGroup& group : groups->groups) {
    frames.push_back(frameOf(group.points));
    const Eigen::Translation3d position(options.depth_scale.value_or(1.0) * group.sensor);
    source.headers.push_back({std::to_string(frames.size() - 1), {}, position * frames.back(), std::nullopt});
  }
  source.stored = "x y z and the sensor's position";
  source.pose = "position of the sensor in the world";
  source.load = [groups, frames](std::size_t index) {
    return turned(groups->groups[index].points, frames[index]);
  };
  DepthSet set = setOfScans(path, std::move(source), options, "points");
  if (groups->is_moving)
    set.notes.push_back("the sensor moves: positions within " + numberText(groups->reach) +
                        " (1 % of the median range) are taken together, " +
                        counted(groups->groups.size(), "view"));
  return set;
}

Detection detectFolder(const fs::path& folder) {
  const std::vector<std::string> files = scansIn(folder);
  if (files.empty()) return {Detection::Fit::No, "no *.ply, *.xyz or *.pcd"};
  std::error_code ignored;
  const bool has_pose = std::any_of(
      files.begin(), files.end(), [&](const std::string& file) { return !poseFileOf(folder, file).empty(); });
  if (has_pose || fs::exists(folder / kTrajectoryFile, ignored))
    return {Detection::Fit::Fully, counted(files.size(), "scan") + " with poses"};
  return {Detection::Fit::Partly,
          counted(files.size(), "file") + " of points, but no *.pose.txt and no " + kTrajectoryFile};
}

Detection detect(const fs::path& path) {
  if (fs::is_directory(path)) return detectFolder(path);
  const bool is_text = path.extension() == ".txt";
  if (!is_text && !isPointFile(path.filename().string()))
    return {Detection::Fit::No, "not a folder and no .ply, .pcd, .xyz or .txt file"};
  // Six columns may be anything.
  if (announcesSensors(path))
    return {is_text ? Detection::Fit::Partly : Detection::Fit::Fully,
            "points with the position of the sensor"};
  return {is_text ? Detection::Fit::No : Detection::Fit::Partly, "points without the position of the sensor"};
}

}  // namespace

DepthSet readPointScans(const fs::path& path, const ReadOptions& options) {
  requirePointOptions(options, DepthKind::Range, "points");
  return fs::is_directory(path) ? readFolder(path, options) : readFile(path, options);
}

DepthSetFormat pointsFormat() {
  return {"points", "points in any order with a known sensor: a folder of scans with poses, or one file",
          "NAME.ply|xyz|pcd   a scan, x forward, y left, z up\n"
          "NAME.pose.txt      4x4 or 3x4 matrix world_from_scan (of scanN also poseN.txt);\n"
          "                   or trajectory.txt: name tx ty tz qx qy qz qw, a line a scan\n"
          "or one file .ply or .pcd with x y z and sensor_x sensor_y sensor_z (or scanner_, origin_, "
          "viewpoint_, vp_;\n"
          "                   x_origin ...), or .xyz with six columns x y z sx sy sz, in world coordinates\n",
          detect, readPointScans};
}

}  // namespace vdbfuse
