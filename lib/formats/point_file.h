// SPDX-License-Identifier: Apache-2.0
// Points in any order from one file: .ply, .pcd (not compressed), .xyz or .txt.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace vdbfuse {

/// Whether a name ends as those of such files do, .txt left out.
bool isPointFile(const std::string& name);

/// x, y and z of every point, whatever else there is. Some may not be finite. Throws IoError.
std::vector<Eigen::Vector3d> readPoints(const std::filesystem::path& path);

struct SensedPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> sensors;  ///< where the sensor stood, of each point
};

/// Points with the position of the sensor: properties or fields sensor_x, scanner_x, origin_x, x_origin,
/// vp_x, viewpoint_x and those of y and z; in text columns 4 to 6 of six. Throws IoError, also when there is
/// no position, or when columns 4 to 6 are normals (of length 1) or colours (whole numbers from 0 to 255).
SensedPoints readSensedPoints(const std::filesystem::path& path);

/// Whether the beginning of the file announces positions of the sensor.
bool announcesSensors(const std::filesystem::path& path);

}  // namespace vdbfuse
