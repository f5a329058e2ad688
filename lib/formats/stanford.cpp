// SPDX-License-Identifier: Apache-2.0
#include "formats/stanford.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "formats/frames.h"
#include "formats/range_scan.h"
#include "formats/stored_depth.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = ".conf";

struct Configuration {
  std::vector<fs::path> files;
  std::vector<RigidTransform> world_from_scan;
  std::size_t meshes = 0;  // lines that are not used
};

// The sensor of a scan, and how its image lies in the file.
struct ScanSensor {
  Projection projection;
  RigidTransform scan_from_camera = RigidTransform::Identity();
  bool mirror_columns = false, mirror_rows = false;
  double error_px = 0;  // of a push-broom
};

struct Scans {
  Configuration configuration;
  std::vector<ScanSensor> sensors;
  ReadOptions options;
  double scale() const { return options.depth_scale.value_or(1.0); }
};

fs::path configurationAt(const fs::path& path) {
  if (!fs::is_directory(path)) return path;
  const std::vector<std::string> names = filesEndingWith(path, kSuffix);
  if (names.empty()) throw IoError(path, "", "a file of scans and poses (*.conf)", "none");
  if (names.size() > 1) throw IoError(path, "", "one .conf file", names[0] + " and " + names[1]);
  return path / names.front();
}

RigidTransform poseOf(const fs::path& path, const TextLine& line) {
  TextLine numbers = line;
  numbers.words.erase(numbers.words.begin(), numbers.words.begin() + 2);
  const std::vector<double> v = finiteNumbers(path, numbers);
  const double length = std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6]));
  if (!(std::abs(length - 1) < kRotationTolerance))
    throw IoError(path, "line " + std::to_string(line.number), "a quaternion of length 1",
                  "length " + numberText(length));
  return stanfordPose({v[0], v[1], v[2]}, v[3], v[4], v[5], v[6]);
}

Configuration readConfiguration(const fs::path& path) {
  constexpr std::size_t kWords = 9;
  Configuration result;
  for (const TextLine& line : readTextLines(path)) {
    const std::string place = "line " + std::to_string(line.number), &key = line.words[0];
    result.meshes += key == "mesh" ? 1 : 0;
    if (key == "camera" || key == "mesh" || key.front() == '#') continue;
    if (key != "bmesh") throw IoError(path, place, "bmesh, mesh or camera", "'" + key.substr(0, 40) + "'");
    if (line.words.size() != kWords)
      throw IoError(path, place, "bmesh FILE tx ty tz qx qy qz qw", counted(line.words.size(), "word"));
    result.files.push_back(pathInside(path.parent_path(), line.words[1], path, place));
    result.world_from_scan.push_back(poseOf(path, line));
  }
  if (result.files.empty()) throw IoError(path, "", "a line 'bmesh FILE tx ty tz qx qy qz qw'", "none");
  return result;
}

template <class Fit>
auto attempt(const Fit& fit, const PointImage& points) -> std::optional<decltype(fit(points))> {
  try {
    return fit(points);
  } catch (const InvalidArgument&) {
    return std::nullopt;
  }
}

std::optional<ScanSensor> pinholeOf(const PointImage& points, const RigidTransform& scan_from_camera) {
  for (const bool columns : {false, true}) {
    for (const bool rows : {false, true}) {
      const auto camera = attempt(fitPinhole, mirrored(points, columns, rows));
      if (camera) return ScanSensor{*camera, scan_from_camera, columns, rows, 0};
    }
  }
  return std::nullopt;
}

ScanSensor upright(FittedPushBroom found, const RigidTransform& scan_from_camera) {
  PushBroom& sensor = found.sensor;
  const bool columns = sensor.x_step < 0, rows = sensor.fy < 0;
  if (columns) sensor.x0 += sensor.x_step * (sensor.width - 1), sensor.x_step = -sensor.x_step;
  if (rows) sensor.cy = sensor.height - 1 - sensor.cy, sensor.fy = -sensor.fy;
  return {sensor, scan_from_camera * Eigen::Translation3d(found.origin), columns, rows, found.error_px};
}

ScanSensor sensorOf(const fs::path& path, const PointImage& points) {
  // A sensor that looks along -z with y up, or along z.
  const std::array<RigidTransform, 2> frames = {openGlFromCamera(), RigidTransform::Identity()};
  for (const RigidTransform& frame : frames) {
    if (const auto found = pinholeOf(moved(points, frame.inverse()), frame)) return *found;
  }
  if (const auto found = attempt(fitPushBroom, moved(points, frames[1]))) return upright(*found, frames[1]);
  try {
    return upright(fitPushBroom(moved(points, frames[0].inverse())), frames[0]);
  } catch (const InvalidArgument& error) {
    throw IoError(path, "", "a scan by a pinhole or by a sheet of light moved sideways", error.what());
  }
}

DepthMap loadScan(const Scans& scans, std::size_t index) {
  const fs::path& path = scans.configuration.files[index];
  const ScanSensor& sensor = scans.sensors[index];
  const PointImage stored = readRangeScan(path, scans.scale());
  if (stored.width() != imageWidth(sensor.projection) || stored.height() != imageHeight(sensor.projection))
    throw IoError(path, "changed since its sensor was found");
  const PointImage points =
      moved(mirrored(stored, sensor.mirror_columns, sensor.mirror_rows), sensor.scan_from_camera.inverse());
  DepthMap map;
  map.depth = depthAtCentres(points, sensor.projection);
  ReadOptions limits = scans.options;
  limits.depth_scale.reset();  // the points are scaled already
  limitPointDepth(map.depth, limits);
  return map;
}

void addNotes(const Scans& scans, std::vector<std::string>& notes) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  std::size_t count = 0;
  for (const ScanSensor& sensor : scans.sensors) {
    if (!std::holds_alternative<PushBroom>(sensor.projection)) continue;
    least = std::min(least, sensor.error_px), most = std::max(most, sensor.error_px);
    ++count;
  }
  const auto rounded = [](double value) { return numberText(0.01 * std::round(100 * value)); };
  if (count > 0)
    notes.push_back(counted(count, "scan") + " by a sheet of light moved sideways, points " + rounded(least) +
                    " to " + rounded(most) + " pixels off the fitted sensor");
  if (const std::size_t meshes = scans.configuration.meshes; meshes > 0)
    notes.push_back(counted(meshes, "mesh line") + " left out");
}

Detection detect(const fs::path& path) {
  const bool is_folder = fs::is_directory(path);
  if (!is_folder && path.extension() != kSuffix)
    return {Detection::Fit::No, "not a folder and no .conf file"};
  if (is_folder && filesEndingWith(path, kSuffix).empty()) return {Detection::Fit::No, "no *.conf"};
  try {
    return {Detection::Fit::Fully,
            counted(readConfiguration(configurationAt(path)).files.size(), "range scan")};
  } catch (const Error&) {
    return {Detection::Fit::Partly, "a .conf file that holds no scans with poses"};
  }
}

}  // namespace

RigidTransform stanfordPose(const Eigen::Vector3d& translation, double qx, double qy, double qz, double qw) {
  RigidTransform result = RigidTransform::Identity();
  result.linear() = Eigen::Quaterniond(qw, qx, qy, qz).normalized().conjugate().toRotationMatrix();
  result.translation() = translation;
  return result;
}

DepthSet readStanford(const fs::path& path, const ReadOptions& options) {
  requirePointOptions(options, DepthKind::Z, "stanford");
  auto scans = std::make_shared<Scans>(Scans{readConfiguration(configurationAt(path)), {}, options});
  const Configuration& configuration = scans->configuration;
  std::vector<ViewHeader> headers;
  for (std::size_t i = 0; i < configuration.files.size(); ++i) {
    const fs::path& file = configuration.files[i];
    scans->sensors.push_back(sensorOf(file, readRangeScan(file, scans->scale())));
    const ScanSensor& sensor = scans->sensors.back();
    headers.push_back({file.stem().string(), sensor.projection,
                       configuration.world_from_scan[i] * sensor.scan_from_camera, std::nullopt});
  }
  DepthSet set;
  for (const ScanSensor& sensor : scans->sensors) set.stored_from_camera.push_back(sensor.scan_from_camera);
  addNotes(*scans, set.notes);
  set.reading = {"x y z, one point a pixel", std::nullopt, scans->scale(), "no vertex, or not finite",
                 "quaternion of scan_from_world and translation of world_from_scan"};
  set.views =
      ViewSequence(std::move(headers), [scans](std::size_t index) { return loadScan(*scans, index); });
  return set;
}

DepthSetFormat stanfordFormat() {
  return {"stanford", "range scans of the Stanford 3D Scanning Repository, a .conf file or its folder",
          "NAME.conf   bmesh FILE tx ty tz qx qy qz qw   a scan and its pose; lines 'camera' and 'mesh' are "
          "not used\n"
          "NAME.ply    vertices x y z and an element range_grid; num_cols and num_rows in obj_info; ascii or "
          "binary\n",
          detect, readStanford};
}

}  // namespace vdbfuse
