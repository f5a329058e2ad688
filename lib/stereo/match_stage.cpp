// SPDX-License-Identifier: Apache-2.0
#include "stereo/match_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereo/matching_constants.h"
#include "vdbfuse/base/rows.h"

namespace vdbfuse::stereo {
namespace {

Eigen::Vector2d seenAt(const ImageMotion& motion, double x, double y, double w) {
  const auto row = [&](std::size_t r) {
    return static_cast<double>(motion.a[3 * r]) * x + static_cast<double>(motion.a[3 * r + 1]) * y +
           static_cast<double>(motion.a[3 * r + 2]) + w * static_cast<double>(motion.b[r]);
  };
  return Eigen::Vector2d(row(0), row(1)) / row(2);
}

ImageMotion motionOf(const MatchInput& input, std::size_t partner, std::size_t level) {
  const PosedPyramid& other = input.partners[partner];
  return imageMotion((*input.reference.levels)[level].camera, input.reference.world_from_camera,
                     (*other.levels)[level].camera, other.world_from_camera);
}

// Leaves out pixels whose rays miss the box.
void leaveOutBeside(const Box& box, const Pinhole& camera, const RigidTransform& world_from_camera,
                    Image<float>& inverse_spread) {
  const Eigen::Vector3d eye = world_from_camera.translation();
  forEachRow(camera.height, 16, [&](int y) {
    for (int x = 0; x < camera.width; ++x) {
      if (inverse_spread(x, y) == 0) continue;
      const Eigen::Vector3d ray = world_from_camera.linear() * unproject(camera, x, y, 1.0);
      double from = 0, to = std::numeric_limits<double>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        const double a = (box.min()[axis] - eye[axis]) / ray[axis],
                     b = (box.max()[axis] - eye[axis]) / ray[axis];
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
      }
      if (!(from <= to)) inverse_spread(x, y) = 0;
    }
  });
}

}  // namespace

Stage stageOf(const MatchInput& input, int level, const StereoOptions& options, double threshold) {
  const auto at = static_cast<std::size_t>(level);
  Stage stage;
  stage.reference = referenceLevel((*input.reference.levels)[at], options.window_px / 2,
                                   static_cast<float>(kLeastDeviation));
  if (options.surface_sweeps > 0) leaveOutRims(stage.reference);
  if (options.domain)
    leaveOutBeside(*options.domain, (*input.reference.levels)[at].camera, input.reference.world_from_camera,
                   stage.reference.inverse_spread);
  for (std::size_t j = 0; j < input.partners.size(); ++j) {
    stage.pictures.push_back(&(*input.partners[j].levels)[at]);
    stage.motions.push_back(motionOf(input, j, at));
  }
  stage.pixel = inverseDepthOfPixel(input, level);
  stage.first = static_cast<float>(1 / input.depths.far),
  stage.last = static_cast<float>(1 / input.depths.near);
  const auto deviation = static_cast<float>(kLeastDeviation * kWhite);
  stage.limits = {static_cast<float>(threshold),
                  deviation * deviation * static_cast<float>(options.window_px * options.window_px)};
  return stage;
}

float inverseDepthOfPixel(const MatchInput& input, int level) {
  const double middle = 0.5 * (1 / input.depths.near + 1 / input.depths.far);
  const auto at = static_cast<std::size_t>(level);
  const Pinhole& camera = (*input.reference.levels)[at].camera;
  double widest = 0;
  for (std::size_t j = 0; j < input.partners.size(); ++j) {
    const ImageMotion motion = motionOf(input, j, at);
    const double x = 0.5 * camera.width, y = 0.5 * camera.height, step = 1e-3 * middle;
    const double moved =
        (seenAt(motion, x, y, middle + step) - seenAt(motion, x, y, middle - step)).norm() / (2 * step);
    if (std::isfinite(moved)) widest = std::max(widest, moved);
  }
  return static_cast<float>(widest > 0 ? 1 / widest : middle);
}

}  // namespace vdbfuse::stereo
