// SPDX-License-Identifier: Apache-2.0
// Correlations a second of the sweeps' kernels on one core, peaks included, for each instruction set that the
// processor has; pixels a second of the votes; and what a view of a whole set costs. CPU time: other work on
// the machine hardly shows.
#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <cmath>
#include <numbers>
#include <string>

#include "stereo/reference_level.h"
#include "stereo/textured_planes.h"
#include "stereo/vote_kernels.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kViews = 8, kPartners = 5;
constexpr double kStep = 6 * std::numbers::pi / 180;  // of the cameras on their arc
constexpr double kDistance = 13.3;                    // a pixel is 0.016 wide there

// A slanted wall before another one, seen from an arc.
const std::vector<Photograph>& photographs() {
  static const std::vector<Photograph> all = [] {
    test::TexturedRectangle wall, front;
    wall.half_u = wall.half_v = 6;
    front.origin = {0.5, 0, -1.5}, front.half_u = 1.5, front.half_v = 1, front.seed = 2;
    front.u = Eigen::Vector3d(0.9, 0, std::sqrt(0.19));
    const Pinhole camera{640, 480, 833, 833, 319.5, 239.5, {}};
    std::vector<Photograph> result;
    for (int i = 0; i < kViews; ++i) {
      const double angle = (i - (kViews - 1) / 2.0) * kStep;
      const Eigen::Vector3d eye(kDistance * std::sin(angle), 0.3 * (i % 3), -kDistance * std::cos(angle));
      result.push_back(
          test::photographOf(test::Rectangles{wall, front},
                             {"camera " + std::to_string(i), camera, lookAt(eye, {0, 0, 0}, {0, -1, 0})}));
    }
    return result;
  }();
  return all;
}

// A tile in the middle of the first photograph, and its motion to the second.
struct Pair {
  std::vector<PictureLevel> reference = picturePyramid(photographs()[0], 1);
  std::vector<PictureLevel> partner = picturePyramid(photographs()[1], 1);
  ImageMotion motion = imageMotion(photographs()[0].camera, photographs()[0].world_from_camera,
                                   photographs()[1].camera, photographs()[1].world_from_camera);
  ReferenceLevel level = referenceLevel(reference[0], 3, 0.006F);
  SweepTile tile;
  SweepLimits limits{0.3F, 7000.0F};

  Pair() {
    const std::vector<TileRect> tiles = tilesOf(level);
    prepareTile(level, tiles[tiles.size() / 2], static_cast<float>(1 / kDistance), tile);
  }
};

// Half a pixel a step.
SweepRange rangeOf(int count) {
  constexpr float kHalfPixel = 4.3e-4F;
  return {-kHalfPixel * static_cast<float>(count) / 2, kHalfPixel, count};
}

void only(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

void count(benchmark::State& state, const std::string& what, double a_round) {
  state.counters[what] = benchmark::Counter(a_round * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate, benchmark::Counter::kIs1000);
  only(0);
}

double windows(const Pair& pair, const SweepRange& range) {
  return static_cast<double>(pair.tile.width) * pair.tile.height * range.count;
}

// As along a surface: a few steps, the best peak.
void sweepBest(benchmark::State& state, std::int64_t target) {
  only(target);
  const Pair pair;
  const SweepRange range = rangeOf(9);
  SweepMemory memory;
  BestPeaks peaks;
  for (auto _ : state)
    sweepForBest(pair.tile, pair.partner[0], pair.motion, range, pair.limits, memory, peaks);
  count(state, "NCC/s", windows(pair, range));
}

// As over all depths: many steps, all peaks.
void sweepLists(benchmark::State& state, std::int64_t target) {
  only(target);
  const Pair pair;
  const SweepRange range = rangeOf(64);
  SweepMemory memory;
  PeakLists lists;
  for (auto _ : state) {
    lists.clear(pair.tile, 1);
    sweepForAll(pair.tile, pair.partner[0], pair.motion, range, pair.limits, 0, memory, lists);
  }
  count(state, "NCC/s", windows(pair, range));
}

void votes(benchmark::State& state, std::int64_t target) {
  only(target);
  constexpr std::size_t kPixels = 6144, kVoters = 11;
  Random random(1);
  std::vector<BestPeaks> peaks(kVoters);
  std::vector<VoterRows> voters;
  for (BestPeaks& rows : peaks) {
    for (std::size_t i = 0; i < kPixels; ++i) {
      rows.step.push_back(static_cast<float>(random.uniform(0, 9)));
      rows.score.push_back(static_cast<float>(random.uniform(-0.3, 1)));
      rows.curvature.push_back(static_cast<float>(random.uniform(0.05, 1)));
    }
    voters.push_back(
        {rows.step.data(), rows.score.data(), rows.curvature.data(), static_cast<int>(voters.size())});
  }
  ModeRows modes;
  for (auto _ : state) countVotes(voters, kPartners, 2, kPixels, {&modes, 1});
  count(state, "pixels/s", kPixels);
}

void wholeSet(benchmark::State& state) {
  const ThreadLimit one(1);
  StereoOptions options;
  options.partners.count = kPartners;
  options.min_depth = kDistance - 3, options.max_depth = kDistance + 3;
  const PhotographSequence sequence = PhotographSequence::fromPhotographs(photographs());
  for (auto _ : state) benchmark::DoNotOptimize(computeDepthMaps(sequence, options));
  state.counters["seconds a view"] =
      benchmark::Counter(kViews * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

}  // namespace
}  // namespace vdbfuse::stereo

int main(int argc, char** argv) {
  using namespace vdbfuse::stereo;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::string name = hwy::TargetName(target);
    benchmark::RegisterBenchmark(("SweepBest/" + name).c_str(), sweepBest, target);
    benchmark::RegisterBenchmark(("SweepLists/" + name).c_str(), sweepLists, target);
    benchmark::RegisterBenchmark(("Votes/" + name).c_str(), votes, target);
  }
  benchmark::RegisterBenchmark("WholeSet", wholeSet)->Unit(benchmark::kMillisecond);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
