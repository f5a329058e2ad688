// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/view.h"

#include <cmath>

namespace vdbfuse {

void normaliseInvalid(Image<float>& depth) {
  for (float& d : depth) {
    if (!(std::isfinite(d) && d > 0)) d = kInvalidDepth;
  }
}

void applyMask(DepthMap& map) {
  for (std::size_t i = 0; i < map.mask.size(); ++i) {
    if (!map.mask.data()[i]) map.depth.data()[i] = kInvalidDepth;
  }
}

Eigen::Vector3d worldPoint(const View& view, int x, int y) {
  return view.world_from_camera * unproject(view.projection, x, y, view.map.depth(x, y));
}

std::vector<std::string> validate(const View& view) {
  std::vector<std::string> problems = validate(view.projection);
  const Image<float>& depth = view.map.depth;
  if (depth.width() != imageWidth(view.projection) || depth.height() != imageHeight(view.projection)) {
    problems.push_back("the depth map is " + std::to_string(depth.width()) + "x" +
                       std::to_string(depth.height()) + ", its projection is for " +
                       std::to_string(imageWidth(view.projection)) + "x" +
                       std::to_string(imageHeight(view.projection)));
  }
  if (!view.map.confidence.empty() && !view.map.confidence.sameSize(depth)) {
    problems.emplace_back("confidence and depth differ in size");
  }
  if (!view.map.mask.empty() && !view.map.mask.sameSize(depth)) {
    problems.emplace_back("mask and depth differ in size");
  }
  if (view.map.alternatives.size() > 3) problems.emplace_back("there are more than three alternative depths");
  for (const DepthAlternative& alternative : view.map.alternatives) {
    if (!alternative.depth.sameSize(depth) || !alternative.share.sameSize(depth))
      problems.emplace_back("an alternative depth or its share differs from the depth in size");
  }
  if (rotationError(view.world_from_camera.linear()) > 1e-6 ||
      !view.world_from_camera.translation().allFinite())
    problems.emplace_back("the pose is not a rigid transform");
  return problems;
}

}  // namespace vdbfuse
