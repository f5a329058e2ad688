// SPDX-License-Identifier: Apache-2.0
#include "stereo/match_view.h"

#include <algorithm>
#include <cmath>

#include "stereo/reference_level.h"
#include "stereo/votes.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kFirstLevelSide = 400;  // pixels, longest side of the level of the first sweep at most
constexpr float kFirstStep = 1.0F;    // pixels of that level
constexpr float kExactStep = 0.5F;    // the same where no surface sweeps follow
constexpr float kFirstThreshold = 0.5F, kSurfaceThreshold = 0.3F;
constexpr float kLeastDeviation = 1.5F / 255;  // of the brightness in a window with texture
constexpr int kSmoothRadius = 3;
constexpr float kSmoothScale = 1.5F;  // pixels of the level

// One level of a match.
struct Stage {
  ReferenceLevel reference;
  std::vector<const PictureLevel*> pictures;
  std::vector<ImageMotion> motions;
  float pixel = 0;            // inverse depth of one pixel
  float first = 0, last = 0;  // range of inverse depths
  SweepLimits limits;
};

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

Stage stageOf(const MatchInput& input, int level, const StereoOptions& options, float threshold) {
  const auto at = static_cast<std::size_t>(level);
  Stage stage;
  stage.reference = referenceLevel((*input.reference.levels)[at], options.window_px / 2, kLeastDeviation);
  for (std::size_t j = 0; j < input.partners.size(); ++j) {
    stage.pictures.push_back(&(*input.partners[j].levels)[at]);
    stage.motions.push_back(motionOf(input, j, at));
  }
  stage.pixel = inverseDepthOfPixel(input, level);
  stage.first = static_cast<float>(1 / input.depths.far),
  stage.last = static_cast<float>(1 / input.depths.near);
  const float deviation = kLeastDeviation * static_cast<float>(kWhite);
  stage.limits = {threshold,
                  deviation * deviation * static_cast<float>(options.window_px * options.window_px)};
  return stage;
}

void store(const Mode& mode, float second, float inverse_depth, float step, int x, int y, DepthLayer& layer) {
  layer.inverse_depth(x, y) = inverse_depth;
  layer.score(x, y) = mode.score;
  layer.second(x, y) = second;
  layer.voters(x, y) = mode.voters;
  layer.spread2(x, y) = mode.spread2 * step * step;
}

template <class Body>
void forEachTile(const ReferenceLevel& reference, const Body& body) {
  const std::vector<TileRect> tiles = tilesOf(reference);
  parallelFor(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(tiles[i]);
  });
}

// Calls use(pixel of the tile, x, y) for every window of it.
template <class Use>
void forEachWindow(const SweepTile& tile, const Use& use) {
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      const std::size_t pixel = tile.at(x, y);
      if (tile.inverse_spread[pixel] > 0) use(pixel, tile.x0 + x, tile.y0 + y);
    }
  }
}

std::vector<Peak> peaksOf(const PeakLists& lists, std::size_t pixel) {
  std::vector<Peak> peaks;
  const auto partners = static_cast<std::size_t>(lists.partners);
  for (std::size_t list = pixel * partners; list < (pixel + 1) * partners; ++list) {
    const auto begin = lists.peaks.begin() + static_cast<std::ptrdiff_t>(list * kMostPeaks);
    peaks.insert(peaks.end(), begin, begin + lists.counts[list]);
  }
  return peaks;
}

// All inverse depths; a step more on each side, because ends are no peaks.
SweepRange fullRange(const Stage& stage, float step_px) {
  const float step = step_px * stage.pixel;
  const int count = std::max(1, static_cast<int>(std::ceil((stage.last - stage.first) / step))) + 3;
  return {-step, step, count};
}

std::vector<DepthLayer> planeSweep(const Stage& stage, float step_px, int hypotheses) {
  const int width = stage.reference.mean.width(), height = stage.reference.mean.height();
  std::vector<DepthLayer> layers(static_cast<std::size_t>(hypotheses), emptyLayer(width, height));
  const SweepRange range = fullRange(stage, step_px);
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
    Voting voting(kVoteSigma * kExactStep / step_px, layers.size() + 1);
    forEachWindow(tile, [&](std::size_t pixel, int x, int y) {
      std::vector<Peak> peaks = peaksOf(lists, pixel);
      for (Peak& peak : peaks) peak.curvature = 1;
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

// Peaks of all partners around a surface.
DepthLayer surfaceSweep(const Stage& stage, const DepthLayer& before, int reach, float step_px) {
  const float step = step_px * stage.pixel;
  const SweepRange range{-step * static_cast<float>(reach), step, 2 * reach + 1};
  DepthLayer layer = before;
  for (float& score : layer.score) score *= 0.5F;
  const Image<float> base =
      filled(smoothed(before, kSmoothRadius, kSmoothScale * stage.pixel), 0.5F * (stage.first + stage.last));
  forEachTile(stage.reference, [&](const TileRect& rect) {
    SweepTile tile;
    SweepMemory memory;
    prepareTile(stage.reference, rect, base, tile);
    std::vector<BestPeaks> best(stage.pictures.size());
    for (std::size_t j = 0; j < stage.pictures.size(); ++j)
      sweepForBest(tile, *stage.pictures[j], stage.motions[j], range, stage.limits, memory, best[j]);
    Voting voting(kVoteSigma * kExactStep / step_px, 2);
    std::vector<Peak> peaks;
    forEachWindow(tile, [&](std::size_t pixel, int x, int y) {
      peaks.clear();
      for (std::size_t j = 0; j < best.size(); ++j) {
        if (best[j].score[pixel] == kNoPeak) continue;
        peaks.push_back({best[j].step[pixel], best[j].score[pixel], best[j].curvature[pixel],
                         static_cast<std::int32_t>(j)});
      }
      const Modes& modes = voting.count(peaks);
      if (modes.empty()) return;
      const float w = base(x, y) + range.first + modes[0].step * range.step;
      store(modes[0], modes.size() > 1 ? modes[1].score : 0.0F, std::clamp(w, stage.first, stage.last),
            range.step, x, y, layer);
    });
  });
  return layer;
}

}  // namespace

int levelsFor(int width, int height, const StereoOptions& options) {
  if (options.surface_sweeps == 0) return 1;
  int levels = 1;
  for (int side = std::max(width, height); side > kFirstLevelSide; side = (side + 1) / 2) ++levels;
  return levels;
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

std::vector<DepthLayer> matchView(const MatchInput& input, const StereoOptions& options) {
  const Pinhole& camera = input.reference.levels->front().camera;
  int level = levelsFor(camera.width, camera.height, options) - 1;
  const bool is_exact = options.surface_sweeps == 0;
  std::vector<DepthLayer> layers = planeSweep(stageOf(input, level, options, kFirstThreshold),
                                              is_exact ? kExactStep : kFirstStep, options.hypotheses);
  if (is_exact) return layers;
  {
    const Stage stage = stageOf(input, level, options, kSurfaceThreshold);
    for (DepthLayer& layer : layers) layer = surfaceSweep(stage, layer, 4, 0.5F);
  }
  while (level > 0) {
    --level;
    const Stage stage = stageOf(input, level, options, kSurfaceThreshold);
    for (DepthLayer& layer : layers) {
      layer = doubled(layer, stage.reference.mean.width(), stage.reference.mean.height(), 2 * stage.pixel);
      for (int sweep = 0; sweep < (level == 0 ? options.surface_sweeps : 1); ++sweep)
        layer = surfaceSweep(stage, layer, sweep == 0 ? 5 : 4, 0.5F);
    }
  }
  return layers;
}

DepthLayer sweepAlong(const MatchInput& input, const StereoOptions& options, const DepthLayer& surface,
                      int reach, float step_px) {
  return surfaceSweep(stageOf(input, 0, options, kSurfaceThreshold), surface, reach, step_px);
}

}  // namespace vdbfuse::stereo
