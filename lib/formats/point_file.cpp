// SPDX-License-Identifier: Apache-2.0
#include "formats/point_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/pcd_columns.h"
#include "formats/xyz_text.h"
#include "io/file_bytes.h"
#include "io/ply_table.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using Columns = std::vector<std::vector<double>>;
using Names = std::vector<std::string>;

constexpr std::size_t kStart = 64 * 1024;
const Names kPoint = {"x", "y", "z"};

const std::vector<Names>& sensorNames() {
  static const std::vector<Names> all = {{"sensor_x", "sensor_y", "sensor_z"},
                                         {"scanner_x", "scanner_y", "scanner_z"},
                                         {"origin_x", "origin_y", "origin_z"},
                                         {"x_origin", "y_origin", "z_origin"},
                                         {"vp_x", "vp_y", "vp_z"},
                                         {"viewpoint_x", "viewpoint_y", "viewpoint_z"}};
  return all;
}

bool isPly(const fs::path& path) { return path.extension() == ".ply"; }
bool isPcd(const fs::path& path) { return path.extension() == ".pcd"; }

// What the header of a PLY or PCD file names.
Names namesOf(const fs::path& path, std::string_view bytes) {
  Names names;
  if (isPcd(path)) {
    for (const io::PcdField& field : io::parsePcdLayout(path, bytes).fields) names.push_back(field.name);
    return names;
  }
  const io::PlyHeader header = io::parsePlyHeader(path, bytes);
  if (const io::PlyElement* vertices = io::findElement(header, "vertex")) {
    for (const io::PlyProperty& p : vertices->properties) names.push_back(p.name);
  }
  return names;
}

// The first of sensorNames() of which all three are there; empty when there is none.
Names sensorsAmong(const Names& names) {
  const auto is_there = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const Names& triple : sensorNames()) {
    if (std::all_of(triple.begin(), triple.end(), is_there)) return triple;
  }
  return {};
}

Columns plyColumns(const fs::path& path, std::string_view bytes, const Names& names) {
  const std::array<io::PlySelection, 1> wanted = {{{"vertex", names}}};
  const io::PlyHeader header = io::parsePlyHeader(path, bytes);
  Columns columns;
  auto table = io::readPlyTable(path, bytes, header, wanted);
  for (io::PlyColumn& column : table.front()) {
    if (!column.ends.empty() || (!columns.empty() && column.values.size() != columns.front().size()))
      throw IoError(path, "element vertex", "single values of x, y and z", "lists");
    columns.push_back(std::move(column.values));
  }
  return columns;
}

Columns namedColumns(const fs::path& path, std::string_view bytes, const Names& names) {
  if (isPly(path)) return plyColumns(path, bytes, names);
  return io::readPcdColumns(path, bytes, io::parsePcdLayout(path, bytes), names);
}

// Three columns as points.
std::vector<Eigen::Vector3d> vectors(const Columns& columns, std::size_t first) {
  std::vector<Eigen::Vector3d> result(columns[first].size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = {columns[first][i], columns[first + 1][i], columns[first + 2][i]};
  return result;
}

// Every `stride` numbers, three from `first` on, as points.
std::vector<Eigen::Vector3d> vectors(const std::vector<double>& numbers, std::size_t stride,
                                     std::size_t first) {
  std::vector<Eigen::Vector3d> result(numbers.size() / stride);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double* p = numbers.data() + i * stride + first;
    result[i] = {p[0], p[1], p[2]};
  }
  return result;
}

bool areUnit(const std::vector<Eigen::Vector3d>& vectors) {
  constexpr double kTolerance = 1e-3;
  return std::all_of(vectors.begin(), vectors.end(),
                     [](const Eigen::Vector3d& v) { return std::abs(v.norm() - 1) < kTolerance; });
}

bool areBytes(const std::vector<Eigen::Vector3d>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(), [](const Eigen::Vector3d& v) {
    return v.minCoeff() >= 0 && v.maxCoeff() <= 255 && v == v.array().floor().matrix();
  });
}

// Normals and colours change from point to point; positions of a sensor that stands still do not.
void requirePositions(const fs::path& path, const std::vector<Eigen::Vector3d>& sensors) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < sensors.size(); ++i) changes += sensors[i] != sensors[i - 1] ? 1 : 0;
  if (10 * changes <= sensors.size()) return;
  const char* found =
      areUnit(sensors) ? "vectors of length 1 (normals?)" : "whole numbers from 0 to 255 (colours?)";
  if (areUnit(sensors) || areBytes(sensors))
    throw IoError(path, "columns 4 to 6", "the position of the sensor for each point", found);
}

SensedPoints sensedText(const fs::path& path) {
  constexpr std::size_t kColumns = 6;
  const std::size_t found = io::xyzColumns(path, io::readFileStart(path, kStart));
  if (found != kColumns)
    throw IoError(path, "",
                  "six columns x y z and the position of the sensor, or a folder with poses of the scans",
                  std::to_string(found) + " columns");
  const std::vector<double> numbers = io::readXyzText(path, kColumns);
  SensedPoints result{vectors(numbers, kColumns, 0), vectors(numbers, kColumns, 3)};
  requirePositions(path, result.sensors);
  return result;
}

}  // namespace

bool isPointFile(const std::string& name) {
  return name.ends_with(".ply") || name.ends_with(".pcd") || name.ends_with(".xyz");
}

std::vector<Eigen::Vector3d> readPoints(const fs::path& path) {
  if (!isPly(path) && !isPcd(path)) return vectors(io::readXyzText(path, 3), 3, 0);
  return vectors(namedColumns(path, io::readFileBytes(path), kPoint), 0);
}

SensedPoints readSensedPoints(const fs::path& path) {
  if (!isPly(path) && !isPcd(path)) return sensedText(path);
  const std::string bytes = io::readFileBytes(path);
  const Names sensors = sensorsAmong(namesOf(path, bytes));
  if (sensors.empty())
    throw IoError(
        path, "",
        "the position of the sensor for each point (sensor_x, vp_x, origin_x, ...), or a folder with poses "
        "of the scans",
        "none");
  Names names = kPoint;
  names.insert(names.end(), sensors.begin(), sensors.end());
  const Columns columns = namedColumns(path, bytes, names);
  return {vectors(columns, 0), vectors(columns, 3)};
}

bool announcesSensors(const fs::path& path) {
  try {
    const std::string start = io::readFileStart(path, kStart);
    if (isPly(path) || isPcd(path)) return !sensorsAmong(namesOf(path, start)).empty();
    return io::xyzColumns(path, start) == 6;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace vdbfuse
