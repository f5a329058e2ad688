// SPDX-License-Identifier: Apache-2.0
#include "formats/trajectory.h"

#include <algorithm>
#include <cmath>

#include "formats/camera_text.h"
#include "formats/image_writer.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

RigidTransform between(const StampedPose& a, const StampedPose& b, double time) {
  const double share = b.time > a.time ? (time - a.time) / (b.time - a.time) : 0;
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = Eigen::Quaterniond(a.pose.linear())
                      .slerp(share, Eigen::Quaterniond(b.pose.linear()))
                      .toRotationMatrix();
  pose.translation() = (1 - share) * a.pose.translation() + share * b.pose.translation();
  return pose;
}

}  // namespace

std::vector<StampedPose> readTrajectory(const std::filesystem::path& path) {
  std::vector<StampedPose> trajectory;
  for (const TextLine& line : readListing(path)) {
    const std::string place = "line " + std::to_string(line.number);
    if (line.words.size() != 8)
      throw IoError(path, place, "time tx ty tz qx qy qz qw", std::to_string(line.words.size()) + " words");
    const std::vector<double> v = finiteNumbers(path, line);
    trajectory.push_back({v[0], poseFromQuaternion(path, place, {v[1], v[2], v[3]},
                                                   Eigen::Quaterniond(v[7], v[4], v[5], v[6]))});
  }
  if (trajectory.empty()) throw IoError(path, "", "a line 'time tx ty tz qx qy qz qw'", "none");
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.time < b.time; });
  return trajectory;
}

std::optional<RigidTransform> poseAt(const std::vector<StampedPose>& trajectory, double time,
                                     double tolerance) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), time,
                                      [](const StampedPose& p, double t) { return p.time < t; });
  if (after != trajectory.end() && after->time == time) return after->pose;
  if (after != trajectory.begin() && after != trajectory.end() &&
      after->time - std::prev(after)->time <= 2 * tolerance)
    return between(*std::prev(after), *after, time);
  const StampedPose* nearest = nullptr;
  if (after != trajectory.end()) nearest = &*after;
  if (after != trajectory.begin() &&
      (nearest == nullptr || time - std::prev(after)->time < nearest->time - time))
    nearest = &*std::prev(after);
  if (nearest == nullptr || std::abs(nearest->time - time) > tolerance) return std::nullopt;
  return nearest->pose;
}

std::string trajectoryLine(const std::string& time, const RigidTransform& pose) {
  const Eigen::Quaterniond q(pose.linear());
  std::string line = time;
  for (const double v :
       {pose.translation().x(), pose.translation().y(), pose.translation().z(), q.x(), q.y(), q.z(), q.w()})
    line += " " + exactText(v);
  return line + "\n";
}

}  // namespace vdbfuse
