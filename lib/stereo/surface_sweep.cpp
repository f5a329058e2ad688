// SPDX-License-Identifier: Apache-2.0
#include "stereo/surface_sweep.h"

#include <algorithm>

#include "stereo/other_voters.h"
#include "stereo/plane_fit.h"
#include "stereo/vote_kernels.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kSmoothRadius = 4;
constexpr float kSmoothScale = 1, kFirstSmoothScale = 4.5F;  // pixels of the level
constexpr int kSmoothRounds = 4;

// One row of the level without its pictures, for votes alone, at one inverse depth.
SweepTile rowOf(const Stage& stage, int y) {
  SweepTile tile;
  tile.y0 = y, tile.width = stage.reference.mean.width(), tile.height = 1, tile.radius = 0;
  tile.stride = (tile.width + kVectorLanes - 1) / kVectorLanes * kVectorLanes;
  tile.base.assign(tile.at(0, 1), stage.first);
  tile.inverse_spread.assign(tile.at(0, 1), 0.0F);
  std::copy_n(stage.reference.inverse_spread.row(y), tile.width, tile.inverse_spread.data());
  return tile;
}

PlaneMap planesOf(const Stage& stage, const DepthLayer& layer) {
  return planeFitted(
      layer.inverse_depth, layer.score,
      {kSmoothRadius, kSmoothScale * stage.pixel, kFirstSmoothScale * stage.pixel, kSmoothRounds});
}

}  // namespace

DepthLayer agreed(const Stage& stage, const DepthLayer& own, const std::vector<Testimony>& others) {
  DepthLayer layer = own;
  const PlaneMap planes = planesOf(stage, own);
  const SweepRange range{0, kExactStep * stage.pixel, 1};
  parallelFor(static_cast<std::size_t>(own.score.height()), 16, [&](std::size_t begin, std::size_t end) {
    OtherVoters memory;
    ModeRows modes;
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      const SweepTile tile = rowOf(stage, y);
      AlignedFloats step(tile.base.size()), score(tile.base.size());
      const AlignedFloats curvature(tile.base.size(), kOtherViewsCurvature);
      forEachWindow(tile, [&](std::size_t pixel, int x, int) {
        if (!(own.inverse_depth(x, y) > 0)) return;
        step[pixel] = (own.inverse_depth(x, y) - stage.first) / range.step;
        score[pixel] = own.score(x, y);
      });
      std::vector<VoterRows> rows{{step.data(), score.data(), curvature.data()}};
      addOtherVoters(others, planes, tile, range, memory, rows);
      countVotes(rows, 1, static_cast<float>(kVoteSigma), tile.base.size(), {&modes, 1});
      forEachWindow(tile, [&](std::size_t pixel, int x, int) {
        const float sum = modes.score[pixel] + modes.support[pixel];
        if (sum == 0) return;
        const float w = stage.first + modes.step[pixel] * range.step;
        layer.inverse_depth(x, y) = std::clamp(w, stage.first, stage.last);
        layer.score(x, y) = sum;
      });
    }
  });
  return layer;
}

DepthLayer surfaceSweep(const Stage& stage, const DepthLayer& before, int reach,
                        const std::vector<Testimony>& others) {
  const float step = kExactStep * stage.pixel;
  const SweepRange range{-step * static_cast<float>(reach), step, 2 * reach + 1};
  const PlaneMap planes = planesOf(stage, before);
  const Guide guide = guideOf(before, planes);
  DepthLayer layer = before;
  for (std::size_t i = 0; i < layer.score.size(); ++i) {
    layer.score.data()[i] *= 0.5F;
    if (stage.reference.inverse_spread.data()[i] == 0) layer.inverse_depth.data()[i] = 0;
  }
  const Image<float> base = filled(guide.inverse_depth, 0.5F * (stage.first + stage.last));
  forEachTile(stage.reference, [&](const TileRect& rect) {
    SweepTile tile;
    SweepMemory memory;
    prepareTile(stage.reference, rect, base, tile);
    std::vector<BestPeaks> best(stage.pictures.size());
    for (std::size_t j = 0; j < stage.pictures.size(); ++j)
      sweepForBest(tile, *stage.pictures[j], stage.motions[j], range, stage.limits, memory, best[j]);
    std::vector<VoterRows> rows;
    for (const BestPeaks& peaks : best)
      rows.push_back(
          {peaks.step.data(), peaks.score.data(), peaks.curvature.data(), static_cast<int>(rows.size())});
    OtherVoters other_rows;
    addOtherVoters(others, planes, tile, range, other_rows, rows);
    ModeRows modes;
    countVotes(rows, best.size(), static_cast<float>(kVoteSigma), tile.at(0, tile.height), {&modes, 1});
    forEachWindow(tile, [&](std::size_t pixel, int x, int y) {
      const float score = modes.score[pixel] + modes.support[pixel];
      if (score == 0) return;
      if (guide.is_foreign(x, y) && score <= before.score(x, y) + before.support(x, y)) {
        layer.score(x, y) = before.score(x, y);
        return;
      }
      const float w = base(x, y) + range.first + modes.step[pixel] * range.step;
      store(modes, pixel, std::clamp(w, stage.first, stage.last), range.step, x, y, layer);
    });
  });
  return layer;
}

}  // namespace vdbfuse::stereo
