// SPDX-License-Identifier: Apache-2.0
#include "stereo/plane_sweep.h"

#include <algorithm>
#include <cmath>

#include "stereo/vote_kernels.h"

namespace vdbfuse::stereo {
namespace {

// All with the same curvature: what windows that face the camera tell of it is worth little.
std::vector<VoterRows> rowsOf(const PeakLists& lists, std::size_t partners, PartnerVotes votes,
                              const AlignedFloats& curvature) {
  std::vector<VoterRows> rows;
  for (std::size_t k = 0; k < partners * kMostPeaks; ++k) {
    const std::size_t voter = votes == PartnerVotes::All ? k : k / kMostPeaks;
    rows.push_back({lists.step.data() + k * lists.pixels, lists.score.data() + k * lists.pixels,
                    curvature.data(), static_cast<int>(voter)});
  }
  return rows;
}

// All inverse depths; a step more on each side, because ends are no peaks.
SweepRange fullRange(const Stage& stage, float step) {
  const int count = std::max(1, static_cast<int>(std::ceil((stage.last - stage.first) / step))) + 3;
  return {-step, step, count};
}

}  // namespace

std::vector<DepthLayer> planeSweep(const Stage& stage, const PlaneSweepOptions& options) {
  const int width = stage.reference.mean.width(), height = stage.reference.mean.height();
  std::vector<DepthLayer> layers(static_cast<std::size_t>(options.hypotheses), emptyLayer(width, height));
  const SweepRange range = fullRange(stage, options.step);
  forEachTile(stage.reference, [&](const TileRect& rect) {
    SweepTile tile;
    SweepMemory memory;
    prepareTile(stage.reference, rect, stage.first, tile);
    PeakLists lists;
    lists.clear(tile, stage.pictures.size());
    for (std::size_t j = 0; j < stage.pictures.size(); ++j)
      sweepForAll(tile, *stage.pictures[j], stage.motions[j], range, stage.limits, j, memory, lists);
    const AlignedFloats curvature(lists.pixels, 1.0F);
    const std::vector<VoterRows> rows = rowsOf(lists, stage.pictures.size(), options.votes, curvature);
    std::vector<ModeRows> modes(layers.size());
    countVotes(rows, rows.size(), options.sigma, lists.pixels, modes);
    for (std::size_t k = 0; k < layers.size(); ++k) {
      forEachWindow(tile, [&](std::size_t pixel, int x, int y) {
        if (modes[k].score[pixel] == 0) return;
        const float w = stage.first + range.first + modes[k].step[pixel] * range.step;
        store(modes[k], pixel, std::clamp(w, stage.first, stage.last), range.step, x, y, layers[k]);
      });
    }
  });
  return layers;
}

}  // namespace vdbfuse::stereo
