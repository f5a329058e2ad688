// SPDX-License-Identifier: Apache-2.0
#include "stereo/match_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereo/matching_constants.h"
#include "stereo/other_voters.h"
#include "stereo/plane_fit.h"
#include "stereo/reference_level.h"
#include "stereo/vote_kernels.h"
#include "stereo/votes.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kFirstLevelSide = 400;  // pixels, longest side of the level of the first sweep at most
constexpr float kFirstStep = 1.0F;    // pixels of that level
constexpr float kExactStep = 0.5F;    // the same where no surface sweeps follow
constexpr int kFirstSweeps = 4;
constexpr int kSmoothRadius = 4;
constexpr float kSmoothScale = 1, kFirstSmoothScale = 8;  // pixels of the level
constexpr int kSmoothRounds = 4;

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

// Leaves out pixels whose rays miss the box.
void leaveOutBeside(const Box& box, const Pinhole& camera, const RigidTransform& world_from_camera,
                    Image<float>& inverse_spread) {
  const Eigen::Vector3d eye = world_from_camera.translation();
  parallelFor(static_cast<std::size_t>(camera.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
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
    }
  });
}

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

void store(const Mode& mode, float second, float inverse_depth, float step, int x, int y, DepthLayer& layer) {
  layer.inverse_depth(x, y) = inverse_depth;
  layer.score(x, y) = mode.score;
  layer.support(x, y) = mode.support;
  layer.second(x, y) = second;
  layer.voters(x, y) = mode.voters;
  layer.spread2(x, y) = mode.spread2 * step * step;
}

Mode modeOf(const ModeRows& modes, std::size_t pixel) {
  return {modes.step[pixel], modes.score[pixel], modes.support[pixel],
          static_cast<std::uint8_t>(modes.voters[pixel]), modes.spread2[pixel]};
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
    Voting voting(static_cast<float>(kVoteSigma) * kExactStep / step_px, layers.size() + 1);
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

// The depth that most of the pixel's own and those of other views agree with.
DepthLayer agreed(const Stage& stage, const DepthLayer& own, const std::vector<Testimony>& others) {
  DepthLayer layer = own;
  const PlaneMap planes = planesOf(stage, own);
  const SweepRange range{0, kExactStep * stage.pixel, 1};
  parallelFor(static_cast<std::size_t>(own.score.height()), 16, [&](std::size_t begin, std::size_t end) {
    OtherVoters rows;
    ModeRows modes;
    std::vector<VoterRows> voters;
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      const SweepTile tile = rowOf(stage, y);
      AlignedFloats step(tile.base.size()), score(tile.base.size());
      forEachWindow(tile, [&](std::size_t pixel, int x, int) {
        if (!(own.inverse_depth(x, y) > 0)) return;
        step[pixel] = (own.inverse_depth(x, y) - stage.first) / range.step;
        score[pixel] = own.score(x, y);
      });
      voters.clear();
      addOtherVoters(others, planes, tile, range, rows, voters);
      voters.insert(voters.begin(), {step.data(), score.data(), rows.curvature.data()});
      countVotes(voters, 1, static_cast<float>(kVoteSigma), tile.base.size(), modes);
      forEachWindow(tile, [&](std::size_t pixel, int x, int) {
        const float sum = modes.score[pixel] + modes.support[pixel];
        if (sum == 0) return;
        layer.inverse_depth(x, y) = stage.first + modes.step[pixel] * range.step;
        layer.score(x, y) = sum;
      });
    }
  });
  return layer;
}

// Peaks of all partners around a surface, and what other views say.
DepthLayer surfaceSweep(const Stage& stage, const DepthLayer& before, int reach,
                        const std::vector<Testimony>& others = {}) {
  const float step = kExactStep * stage.pixel, step_px = kExactStep;
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
    OtherVoters other_rows;
    std::vector<VoterRows> voters;
    for (const BestPeaks& peaks : best)
      voters.push_back({peaks.step.data(), peaks.score.data(), peaks.curvature.data()});
    addOtherVoters(others, planes, tile, range, other_rows, voters);
    ModeRows modes;
    countVotes(voters, best.size(), static_cast<float>(kVoteSigma) * kExactStep / step_px,
               tile.at(0, tile.height), modes);
    forEachWindow(tile, [&](std::size_t pixel, int x, int y) {
      const Mode mode = modeOf(modes, pixel);
      if (mode.score + mode.support == 0) return;
      const float before_score = before.score(x, y) + before.support(x, y);
      if (guide.is_foreign(x, y) && mode.score + mode.support <= before_score) {
        layer.score(x, y) = before.score(x, y);
        return;
      }
      const float w = base(x, y) + range.first + mode.step * range.step;
      store(mode, modes.second[pixel], std::clamp(w, stage.first, stage.last), range.step, x, y, layer);
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
  for (bool is_first = true; level >= 0; --level, is_first = false) {
    const Stage stage = stageOf(input, level, options, kSurfaceThreshold);
    for (DepthLayer& layer : layers) {
      if (!is_first)
        layer = doubled(layer, stage.reference.mean.width(), stage.reference.mean.height(), 2 * stage.pixel);
      const int sweeps = is_first ? kFirstSweeps : level == 0 ? options.surface_sweeps : 2;
      for (int sweep = 0; sweep < sweeps; ++sweep) layer = surfaceSweep(stage, layer, sweep == 0 ? 5 : 4);
    }
  }
  return layers;
}

DepthLayer crossChecked(const MatchInput& input, const StereoOptions& options, const DepthLayer& own,
                        const std::vector<Testimony>& others, int reach) {
  const Stage stage = stageOf(input, 0, options, kSurfaceThreshold);
  return surfaceSweep(stage, agreed(stage, own, others), reach, others);
}

}  // namespace vdbfuse::stereo
