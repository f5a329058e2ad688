// SPDX-License-Identifier: Apache-2.0
// Depths of one photograph by sweeping over its partners: planes first, over all depths at a coarse level;
// then along the surface that was found, on finer and finer levels.
#pragma once

#include <memory>
#include <vector>

#include "stereo/cross_view.h"
#include "stereo/picture_pyramid.h"
#include "stereo/surface.h"
#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse::stereo {

struct PosedPyramid {
  std::shared_ptr<const std::vector<PictureLevel>> levels;
  RigidTransform world_from_camera = RigidTransform::Identity();
};

struct MatchInput {
  PosedPyramid reference;
  std::vector<PosedPyramid> partners;
  DepthInterval depths;
};

/// Levels of the pyramid that matchView() needs for pictures of this size.
int levelsFor(int width, int height, const StereoOptions& options);

/// Inverse depth by which the picture moves by one pixel of level `level` in the widest partner, in the
/// middle of the picture and of its depths.
float inverseDepthOfPixel(const MatchInput& input, int level);

/// Of level 0, one for each of StereoOptions::hypotheses, the best first.
std::vector<DepthLayer> matchView(const MatchInput& input, const StereoOptions& options);

/// Weighs the depths against what other views say of them, and sweeps once more along the result. What is not
/// found keeps its value and half its score.
DepthLayer crossChecked(const MatchInput& input, const StereoOptions& options, const DepthLayer& own,
                        const std::vector<Testimony>& others, int reach);

}  // namespace vdbfuse::stereo
