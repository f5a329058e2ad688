// SPDX-License-Identifier: Apache-2.0
// Before the matching: which photographs to match with which, and where depths may lie.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {

/// Which photographs a photograph is matched with.
struct PartnerOptions {
  std::size_t count = 5;       ///< partners of a photograph; more see more occlusion and cost in proportion
  double min_angle_deg = 5.0;  ///< between the lines of sight to the middle of what is seen
  double max_angle_deg = 45.0;
};

/// The depths that photograph `index` may see. From, in this order: what the header says, cut to the box
/// where one is given (the box alone where they exclude each other); the box, by its corners; where the
/// cameras look: the point nearest to all optical axes and a ball around it that fills at least two pictures
/// to their corners. Where the axes do not meet, or not in this picture (forward and sideways motion,
/// cameras that look outwards), 2 to 200 times the median distance to the five nearest cameras. Of a camera
/// inside the box or the ball, near is far/20. Throws InvalidArgument when the box is empty or lies behind
/// the camera, or nothing is said and there is no photograph from another place.
DepthInterval depthsOf(const std::vector<PhotographHeader>& photographs, std::size_t index,
                       const std::optional<Box>& box);

/// For each photograph the others to match it with, best first: nearest in angle, as seen from the middle of
/// the picture at the middle (in logarithm) of its `depths`, among those that see that point at a scale up to
/// 2.5 times finer or coarser, within the limits of angle; on all sides of the line of sight, and 3° from
/// each other, where there are such. Short of these, what comes nearest to it; but with two partners at hand
/// none beyond 1.25 times the largest angle. Found through FLANN over the poses: of several thousand
/// photographs the nearest 1024 are looked at. Never empty when there are two photographs that see the same
/// place. Throws InvalidArgument unless there is one interval for each photograph.
std::vector<std::vector<std::size_t>> choosePartners(const std::vector<PhotographHeader>& photographs,
                                                     const std::vector<DepthInterval>& depths,
                                                     const PartnerOptions& options = {});

}  // namespace vdbfuse
