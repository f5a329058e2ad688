// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/neighbours.h"

#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <numbers>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

using Feature = Eigen::Matrix<float, 6, 1>;

// More than this many nearest photographs are never looked at.
constexpr std::size_t kMostCandidates = 1024;
// Partners this near each other see the same occlusions and make the same mistakes.
constexpr double kSeparation = 3 * std::numbers::pi / 180;
// Pixels of a partner may be this much larger or smaller on the surface.
constexpr double kScaleRatio = 2.5;
// With two partners at hand, further ones are not sought beyond this multiple of the largest angle: windows
// look too different to agree.
constexpr double kStretch = 1.25;
constexpr std::size_t kFewest = 2;

// What is wrong with a partner, in degrees of angle that one would rather go further for.
constexpr double kSameSideDeg = 15;    // another partner lies on the same side; at most twice
constexpr double kSamePlaceDeg = 90;   // another partner lies at the same place
constexpr double kOffLimitsDeg = 200;  // the angle is half the smallest or twice the largest
constexpr double kOffScaleDeg = 200;
constexpr double kMiddleUnseenDeg = 1000;

// A photograph as seen from the middle of what the reference sees.
struct Candidate {
  std::size_t number = 0;
  Eigen::Vector3d direction;  // to its camera, unit
  Eigen::Vector3d side;       // of the line of sight on which it lies, unit; 0 on the line itself
  double angle_deg = 0;       // between the lines of sight
  double cost_deg = 0;        // without regard to the other partners
};

double middleOf(const DepthInterval& depths) { return std::sqrt(depths.near * depths.far); }

double degreesBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

// Points all over what a photograph sees, the middle of it first.
std::vector<Eigen::Vector3d> pointsSeen(const PhotographHeader& photograph, const DepthInterval& depths) {
  const Pinhole& camera = photograph.camera;
  std::vector<Eigen::Vector3d> points;
  for (const double depth : {middleOf(depths), depths.near, depths.far})
    for (const double v : {0.5, 0.1, 0.9})
      for (const double u : {0.5, 0.1, 0.9})
        points.push_back(photograph.world_from_camera *
                         unproject(camera, u * camera.width - 0.5, v * camera.height - 0.5, depth));
  return points;
}

// 1: pixels of both are equally large at the point.
double scaleRatio(const PhotographHeader& a, const PhotographHeader& b, const Eigen::Vector3d& point) {
  const auto size = [&](const PhotographHeader& photograph) {
    return (point - photograph.world_from_camera.translation()).norm() / photograph.camera.fx;
  };
  return std::max(size(a) / size(b), size(b) / size(a));
}

// Below the smallest angle depths are uncertain at once; beyond the largest, windows differ more and more.
double offLimits(double angle_deg, const PartnerOptions& options) {
  if (angle_deg < options.min_angle_deg) return kOffLimitsDeg * (1.5 - angle_deg / options.min_angle_deg);
  return kOffLimitsDeg * std::max(0.0, angle_deg / options.max_angle_deg - 1);
}

std::vector<std::vector<std::size_t>> nearestPoses(const std::vector<PhotographHeader>& photographs,
                                                   const std::vector<DepthInterval>& depths) {
  std::vector<double> middles;
  for (const DepthInterval& interval : depths) middles.push_back(middleOf(interval));
  const auto typical = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
  std::nth_element(middles.begin(), typical, middles.end());
  std::vector<Feature> features(photographs.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    const RigidTransform& pose = photographs[i].world_from_camera;
    features[i] << pose.linear().col(2).cast<float>(), (pose.translation() / *typical).cast<float>();
  }
  const flann::Matrix<float> poses(features.front().data(), features.size(), 6);
  flann::Index<flann::L2<float>> index(poses, flann::KDTreeSingleIndexParams());
  index.buildIndex();
  std::vector<std::vector<std::size_t>> found;
  std::vector<std::vector<float>> distances;
  index.knnSearch(poses, found, distances, std::min(features.size(), kMostCandidates),
                  flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  return found;
}

// Choice of the partners of one photograph.
class Choice {
 public:
  Choice(const std::vector<PhotographHeader>& photographs, std::size_t reference, const DepthInterval& depths,
         const PartnerOptions& options)
      : photographs_(photographs),
        reference_(photographs[reference]),
        points_(pointsSeen(reference_, depths)),
        sight_((reference_.world_from_camera.translation() - points_.front()).normalized()),
        options_(options) {}

  // Nothing for a photograph that sees nothing of what the reference sees.
  void consider(std::size_t number) {
    const PhotographHeader& other = photographs_[number];
    const Projector projector(other.camera, other.world_from_camera);
    const auto sees = [&](const Eigen::Vector3d& point) { return projector(point).has_value(); };
    const auto shared = std::count_if(points_.begin(), points_.end(), sees);
    if (shared == 0) return;
    Candidate candidate{number, (other.world_from_camera.translation() - points_.front()).normalized(), {}};
    candidate.side = candidate.direction - candidate.direction.dot(sight_) * sight_;
    if (candidate.side.norm() > 0) candidate.side.normalize();
    candidate.angle_deg = degreesBetween(candidate.direction, sight_);
    candidate.cost_deg = candidate.angle_deg + offLimits(candidate.angle_deg, options_);
    const double ratio = scaleRatio(reference_, other, points_.front());
    if (ratio > kScaleRatio) candidate.cost_deg += kOffScaleDeg * ratio / kScaleRatio;
    if (!sees(points_.front())) candidate.cost_deg += kMiddleUnseenDeg / static_cast<double>(shared);
    candidates_.push_back(candidate);
  }

  // One after the other, each the best beside those before it; the first of equals.
  std::vector<std::size_t> choose() {
    std::vector<std::size_t> numbers;
    while (!candidates_.empty() && chosen_.size() < options_.count) {
      const auto best =
          std::min_element(candidates_.begin(), candidates_.end(),
                           [this](const Candidate& a, const Candidate& b) { return costOf(a) < costOf(b); });
      if (chosen_.size() >= kFewest && best->angle_deg > kStretch * options_.max_angle_deg) break;
      numbers.push_back(best->number);
      chosen_.push_back(*best);
      candidates_.erase(best);
    }
    return numbers;
  }

 private:
  double costOf(const Candidate& candidate) const {
    double nearest = kSeparation;
    double same_side = 0;
    for (const Candidate& other : chosen_) {
      nearest = std::min(nearest, (candidate.direction - other.direction).norm());
      same_side += candidate.side.dot(other.side);
    }
    return candidate.cost_deg + kSameSideDeg * std::clamp(same_side, 0.0, 2.0) +
           kSamePlaceDeg * (1 - nearest / kSeparation);
  }

  const std::vector<PhotographHeader>& photographs_;
  const PhotographHeader& reference_;
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d sight_;  // from the middle to the reference, unit
  const PartnerOptions& options_;
  std::vector<Candidate> candidates_, chosen_;
};

}  // namespace

std::vector<std::vector<std::size_t>> choosePartners(const std::vector<PhotographHeader>& photographs,
                                                     const std::vector<DepthInterval>& depths,
                                                     const PartnerOptions& options) {
  if (depths.size() != photographs.size()) throw InvalidArgument("depths", "must be one per photograph");
  std::vector<std::vector<std::size_t>> partners(photographs.size());
  if (photographs.empty()) return partners;
  std::vector<std::vector<std::size_t>> candidates = nearestPoses(photographs, depths);
  parallelFor(photographs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::sort(candidates[i].begin(), candidates[i].end());
      Choice choice(photographs, i, depths[i], options);
      for (const std::size_t other : candidates[i])
        if (other != i) choice.consider(other);
      partners[i] = choice.choose();
    }
  });
  return partners;
}

}  // namespace vdbfuse
