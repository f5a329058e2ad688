// SPDX-License-Identifier: Apache-2.0
#include "stereo/match_view.h"

#include <algorithm>

#include "stereo/matching_constants.h"
#include "stereo/paper_ray.h"
#include "stereo/plane_sweep.h"
#include "stereo/surface_sweep.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kFirstLevelSide = 400;        // pixels, longest side of the level of the first sweep at most
constexpr float kFirstStep = 1.0F;          // pixels of that level
constexpr int kFirstSweeps = 4;             // along the surface at that level, where they cost little
constexpr int kMiddleSweeps = 2;            // at levels between that and the finest
constexpr int kFirstReach = 5, kReach = 4;  // steps

// From one plane to the next in mode `paper`.
float paperStep(const MatchInput& input) {
  const auto header = [](const PosedPyramid& photograph) {
    return PhotographHeader{"", photograph.levels->front().camera, photograph.world_from_camera};
  };
  std::vector<PhotographHeader> partners;
  for (const PosedPyramid& partner : input.partners) partners.push_back(header(partner));
  const auto steps = paper::raySteps(header(input.reference), partners, input.depths, kPaperStep);
  return static_cast<float>(steps.step);
}

// Where no surface sweeps follow the result is that of mode `paper`.
PlaneSweepOptions firstSweep(const MatchInput& input, const Stage& stage, const StereoOptions& options) {
  const auto sigma = static_cast<float>(kVoteSigma);
  if (options.surface_sweeps == 0) return {paperStep(input), sigma, PartnerVotes::All, options.hypotheses};
  return {kFirstStep * stage.pixel, sigma * kExactStep / kFirstStep, PartnerVotes::Best, options.hypotheses};
}

DepthLayer enlarged(const DepthLayer& layer, const Stage& stage) {
  return doubled(layer, stage.reference.mean.width(), stage.reference.mean.height(), 2 * stage.pixel);
}

}  // namespace

int levelsFor(int width, int height, const StereoOptions& options) {
  if (options.surface_sweeps == 0) return 1;
  int levels = 1;
  for (int side = std::max(width, height); side > kFirstLevelSide; side = (side + 1) / 2) ++levels;
  return levels;
}

ViewMatch matchView(const MatchInput& input, const StereoOptions& options) {
  const Pinhole& camera = input.reference.levels->front().camera;
  const int first = levelsFor(camera.width, camera.height, options) - 1;
  ViewMatch match;
  Stage stage = stageOf(input, first, options, kFirstThreshold);
  match.modes = planeSweep(stage, firstSweep(input, stage, options));
  match.best = match.modes.front();
  if (options.hypotheses == 1) match.modes.clear();
  if (options.surface_sweeps == 0) return match;
  stage.limits.threshold = static_cast<float>(kSurfaceThreshold);
  for (int level = first; level >= 0; --level) {
    if (level < first) {
      stage = stageOf(input, level, options, kSurfaceThreshold);
      match.best = enlarged(match.best, stage);
      for (DepthLayer& mode : match.modes) mode = enlarged(mode, stage);
    }
    const int sweeps = level == first ? std::max(kFirstSweeps, options.surface_sweeps)
                       : level > 0    ? kMiddleSweeps
                                      : options.surface_sweeps;
    for (int sweep = 0; sweep < sweeps; ++sweep)
      match.best = surfaceSweep(stage, match.best, sweep == 0 ? kFirstReach : kReach);
  }
  return match;
}

DepthLayer crossChecked(const MatchInput& input, const StereoOptions& options, const DepthLayer& own,
                        const std::vector<Testimony>& others, int reach) {
  const Stage stage = stageOf(input, 0, options, kSurfaceThreshold);
  return surfaceSweep(stage, agreed(stage, own, others), reach, others);
}

}  // namespace vdbfuse::stereo
