// SPDX-License-Identifier: Apache-2.0
#include "formats/sensor_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Cell = std::array<double, 3>;

std::vector<std::size_t> usablePoints(const SensedPoints& sensed) {
  std::vector<std::size_t> usable;
  for (std::size_t i = 0; i < sensed.points.size(); ++i) {
    if (sensed.points[i].allFinite() && sensed.sensors[i].allFinite()) usable.push_back(i);
  }
  return usable;
}

double medianRange(const SensedPoints& sensed, const std::vector<std::size_t>& usable) {
  std::vector<double> ranges;
  for (const std::size_t i : usable) ranges.push_back((sensed.points[i] - sensed.sensors[i]).norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

// Positions where groups began, in cells of the size of the reach.
class Starts {
 public:
  explicit Starts(double reach) : reach_(reach) {}

  // The group that `sensor` belongs to; a new one when there is none near.
  std::size_t groupOf(const Eigen::Vector3d& sensor) {
    if (!starts_.empty() && isNear(last_, sensor)) return last_;
    const Cell cell = cellOf(sensor);
    for (double x = -1; x <= 1; ++x) {
      for (double y = -1; y <= 1; ++y) {
        for (double z = -1; z <= 1; ++z) {
          if (const auto found = nearIn({cell[0] + x, cell[1] + y, cell[2] + z}, sensor);
              found < starts_.size())
            return last_ = found;
        }
      }
    }
    if (starts_.size() == kMostSensors)
      throw InvalidArgument("points",
                            "expected at most " + std::to_string(kMostSensors) +
                                " positions of the sensor, 1 % of the median range apart, found more");
    cells_[cell].push_back(starts_.size());
    starts_.push_back(sensor);
    return last_ = starts_.size() - 1;
  }

  const Eigen::Vector3d& start(std::size_t group) const { return starts_[group]; }
  std::size_t size() const { return starts_.size(); }

 private:
  bool isNear(std::size_t group, const Eigen::Vector3d& sensor) const {
    return (starts_[group] - sensor).norm() <= reach_;
  }
  Cell cellOf(const Eigen::Vector3d& p) const {
    return {std::floor(p.x() / reach_), std::floor(p.y() / reach_), std::floor(p.z() / reach_)};
  }
  std::size_t nearIn(const Cell& cell, const Eigen::Vector3d& sensor) const {
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return starts_.size();
    for (const std::size_t group : found->second) {
      if (isNear(group, sensor)) return group;
    }
    return starts_.size();
  }

  double reach_;
  std::vector<Eigen::Vector3d> starts_;
  std::map<Cell, std::vector<std::size_t>> cells_;
  std::size_t last_ = 0;
};

}  // namespace

SensorGroups groupBySensor(const SensedPoints& sensed) {
  const std::vector<std::size_t> usable = usablePoints(sensed);
  const double range = usable.empty() ? 0 : medianRange(sensed, usable);
  if (!(range > 0 && std::isfinite(range)))
    throw InvalidArgument("points", "expected finite points away from their sensor, found none");
  SensorGroups result;
  result.reach = kSensorReach * range;
  Starts starts(result.reach);
  std::vector<std::vector<std::size_t>> members;
  for (const std::size_t i : usable) {
    const std::size_t group = starts.groupOf(sensed.sensors[i]);
    if (group == members.size()) members.emplace_back();
    members[group].push_back(i);
    result.is_moving = result.is_moving || sensed.sensors[i] != starts.start(group);
  }
  for (const std::vector<std::size_t>& points : members) {
    SensorGroup group;
    for (const std::size_t i : points) group.sensor += sensed.sensors[i] / static_cast<double>(points.size());
    for (const std::size_t i : points)
      group.points.emplace_back((sensed.points[i] - group.sensor).cast<float>());
    result.groups.push_back(std::move(group));
  }
  return result;
}

}  // namespace vdbfuse
