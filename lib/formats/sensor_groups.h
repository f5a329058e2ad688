// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "formats/point_file.h"

namespace vdbfuse {

/// Points that one position of a sensor saw.
struct SensorGroup {
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  ///< the mean of theirs
  std::vector<Eigen::Vector3f> points;               ///< from `sensor`, axes of the world
};

struct SensorGroups {
  std::vector<SensorGroup> groups;  ///< in the order in which they are first met; each holds a point
  /// Positions no further apart than this are one: kSensorReach times the median range.
  double reach = 0;
  /// Whether a group holds points of several positions: the sensor moved.
  bool is_moving = false;
};

inline constexpr double kSensorReach = 0.01;
inline constexpr std::size_t kMostSensors = 10000;

/// Each point joins the group of the point before, or another, that began within `reach` of its sensor; else
/// it begins one. What is not finite is left out. Throws InvalidArgument: no point is left, or more than
/// kMostSensors groups come to be.
SensorGroups groupBySensor(const SensedPoints& sensed);

}  // namespace vdbfuse
