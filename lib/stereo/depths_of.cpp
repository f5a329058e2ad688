// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/stereo/neighbours.h"

namespace vdbfuse {
namespace {

// Of a camera inside the box, or among what it sees: depths nearer than far/20 cost most of the steps and
// show next to nothing.
constexpr double kNearestShare = 0.05;
// Of cameras whose axes do not meet, in distances between neighbouring cameras. Nearer than the first, two
// photographs hardly overlap; beyond the second, a camera 1000 pixels wide sees disparities below 5 pixels.
constexpr double kNearBaselines = 2, kFarBaselines = 200;
constexpr std::size_t kNeighboursOfBaseline = 5;
// Mean square of the sine between the axes and their mean: below (2°)² they count as parallel.
constexpr double kParallel = 1.2e-3;

DepthInterval depthsOfBox(const PhotographHeader& photograph, const Box& box) {
  if (box.isEmpty()) throw InvalidArgument("box", "is empty");
  const RigidTransform camera_from_world = photograph.world_from_camera.inverse();
  DepthInterval depths{INFINITY, -INFINITY};
  for (int corner = 0; corner < 8; ++corner) {
    const double z = (camera_from_world * box.corner(static_cast<Box::CornerType>(corner))).z();
    depths.near = std::min(depths.near, z);
    depths.far = std::max(depths.far, z);
  }
  if (!(depths.far > 0)) throw InvalidArgument("box", "lies behind photograph " + photograph.name);
  return {std::max(depths.near, kNearestShare * depths.far), depths.far};
}

// The box is somebody's word: where the data disagree altogether, it holds.
DepthInterval cutTo(const DepthInterval& depths, const DepthInterval& box) {
  const DepthInterval cut{std::max(depths.near, box.near), std::min(depths.far, box.far)};
  return cut.near < cut.far ? cut : box;
}

// Nearest to all optical axes, in the sense of least squares; nothing where these are parallel.
std::optional<Eigen::Vector3d> pointLookedAt(const std::vector<PhotographHeader>& photographs) {
  Eigen::Matrix3d across = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PhotographHeader& photograph : photographs) {
    const Eigen::Vector3d axis = photograph.world_from_camera.linear().col(2);
    const Eigen::Matrix3d reject = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    across += reject;
    sum += reject * photograph.world_from_camera.translation();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(across, Eigen::EigenvaluesOnly);
  if (spread.eigenvalues()[0] < kParallel * static_cast<double>(photographs.size())) return std::nullopt;
  return across.ldlt().solve(sum);
}

// The point as the photograph sees it; nothing when it lies behind it or outside its picture.
std::optional<PixelDepth> seenBy(const PhotographHeader& photograph, const Eigen::Vector3d& point) {
  const auto seen = project(photograph.camera, photograph.world_from_camera.inverse() * point);
  if (!seen || std::abs(seen->x - photograph.camera.cx) > photograph.camera.width / 2.0 ||
      std::abs(seen->y - photograph.camera.cy) > photograph.camera.height / 2.0)
    return std::nullopt;
  return seen;
}

// Of the largest ball around the point that reaches into the corners of at least two pictures.
double radiusSeen(const std::vector<PhotographHeader>& photographs, const Eigen::Vector3d& point) {
  std::vector<double> radii;
  for (const PhotographHeader& photograph : photographs) {
    const Pinhole& camera = photograph.camera;
    const auto seen = seenBy(photograph, point);
    if (seen)
      radii.push_back(seen->depth * std::hypot(camera.width / camera.fx, camera.height / camera.fy) / 2);
  }
  if (radii.size() < 2) return 0;
  std::nth_element(radii.begin(), radii.begin() + 1, radii.end(), std::greater<>());
  return radii[1];
}

DepthInterval depthsFromBaselines(const std::vector<PhotographHeader>& photographs, std::size_t index) {
  std::vector<double> distances;
  for (const PhotographHeader& other : photographs) {
    const double distance =
        (other.world_from_camera.translation() - photographs[index].world_from_camera.translation()).norm();
    if (distance > 0) distances.push_back(distance);
  }
  if (distances.empty())
    throw InvalidArgument("photographs", "nothing tells the depths of " + photographs[index].name +
                                             ": no box, and no photograph from another place");
  std::sort(distances.begin(), distances.end());
  const double baseline = distances[(std::min(distances.size(), kNeighboursOfBaseline) - 1) / 2];
  return {kNearBaselines * baseline, kFarBaselines * baseline};
}

DepthInterval depthsFromCameras(const std::vector<PhotographHeader>& photographs, std::size_t index) {
  const auto point = photographs.size() > 1 ? pointLookedAt(photographs) : std::nullopt;
  const auto seen = point ? seenBy(photographs[index], *point) : std::nullopt;
  const double radius = seen ? radiusSeen(photographs, *point) : 0;
  if (!(radius > 0)) return depthsFromBaselines(photographs, index);
  const double far = seen->depth + radius;
  return {std::max(seen->depth - radius, kNearestShare * far), far};
}

}  // namespace

DepthInterval depthsOf(const std::vector<PhotographHeader>& photographs, std::size_t index,
                       const std::optional<Box>& box) {
  const PhotographHeader& photograph = photographs[index];
  const auto of_box = box ? std::optional(depthsOfBox(photograph, *box)) : std::nullopt;
  if (photograph.depth) return of_box ? cutTo(*photograph.depth, *of_box) : *photograph.depth;
  return of_box ? *of_box : depthsFromCameras(photographs, index);
}

}  // namespace vdbfuse
