// SPDX-License-Identifier: Apache-2.0
#include "stereo/plane_sweep.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse::stereo {
namespace {

// Replaces `peaks`, all with the same curvature: what windows that face the camera tell of it is worth
// little.
void collect(const PeakLists& lists, std::size_t pixel, std::vector<Peak>& peaks) {
  peaks.clear();
  const auto partners = static_cast<std::size_t>(lists.partners);
  for (std::size_t list = pixel * partners; list < (pixel + 1) * partners; ++list) {
    const Peak* first = lists.peaks.data() + list * kMostPeaks;
    peaks.insert(peaks.end(), first, first + lists.counts[list]);
  }
  for (Peak& peak : peaks) peak.curvature = 1;
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
    lists.partners = static_cast<int>(stage.pictures.size());
    lists.counts.assign(tile.at(0, tile.height) * stage.pictures.size(), 0);
    lists.peaks.resize(lists.counts.size() * kMostPeaks);
    for (std::size_t j = 0; j < stage.pictures.size(); ++j)
      sweepForAll(tile, *stage.pictures[j], stage.motions[j], range, stage.limits, static_cast<int>(j),
                  memory, lists);
    Voting voting(options.sigma, layers.size() + 1, options.votes);
    std::vector<Peak> peaks;
    forEachWindow(tile, [&](std::size_t pixel, int x, int y) {
      collect(lists, pixel, peaks);
      const Modes& modes = voting.count(peaks);
      for (std::size_t k = 0; k < std::min(modes.size(), layers.size()); ++k) {
        const float w = stage.first + range.first + modes[k].step * range.step;
        store(modes[k], k + 1 < modes.size() ? modes[k + 1].score : 0.0F,
              std::clamp(w, stage.first, stage.last), range.step, x, y, layers[k]);
      }
    });
  });
  return layers;
}

}  // namespace vdbfuse::stereo
