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
/// where one is given; the box; where the cameras look (the point nearest to all optical axes, and all that
/// at least two cameras see around it). Throws InvalidArgument when the box lies behind the camera, or
/// nothing is said and a single camera is left.
DepthInterval depthsOf(const std::vector<PhotographHeader>& photographs, std::size_t index,
                       const std::optional<Box>& box);

/// For each photograph the others to match it with: nearest in angle, as seen from the point at the middle of
/// its `depths`, among those that look at it, within the limits of angle where there are enough, else the
/// nearest to the limits. Found through FLANN over the poses. Never empty when there are two photographs that
/// see the same place.
std::vector<std::vector<std::size_t>> choosePartners(const std::vector<PhotographHeader>& photographs,
                                                     const std::vector<DepthInterval>& depths,
                                                     const PartnerOptions& options = {});

}  // namespace vdbfuse
