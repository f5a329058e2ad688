// SPDX-License-Identifier: Apache-2.0
// (voxel, view) pairs a second of the evidence on one core, its parts and its whole, and what the same
// machine copies.
#include <benchmark/benchmark.h>

#include <cstring>

#include "fusion/block_kernels.h"
#include "fusion/scenes.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/evidence.h"

namespace vdbfuse {
namespace {

constexpr int kViews = 24;
constexpr double kVoxel = 0.004;

const JudgedViews& scan() {
  static const JudgedViews judged = [] {
    std::vector<View> views;
    const Pinhole camera{640, 480, 900, 900, 319.5, 239.5, {}};
    for (int i = 0; i < kViews; ++i)
      views.push_back(test::castView(2.0 * test::fibonacciDirection(i, kViews), Eigen::Vector3d::Zero(),
                                     camera, test::sphereCaster(0.5)));
    test::addNoise(views, {0.002, 0, 0}, 1);
    return believe(std::move(views), {gaussianNoise(), {0.002, 0, 0}, 1.2, 2.8}, 0.01);
  }();
  return judged;
}

// Leaves along the surface of the sphere, as the finest cells of an octree are.
std::vector<std::vector<Eigen::Vector3d>> blocks(int count) {
  std::vector<std::vector<Eigen::Vector3d>> result;
  for (int b = 0; b < count; ++b) {
    const Eigen::Vector3d corner = 0.5 * test::fibonacciDirection(b, count);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 512; ++k)
      points.push_back(corner + kVoxel * Eigen::Vector3d(k >> 6, k >> 3 & 7, k & 7));
    result.push_back(std::move(points));
  }
  return result;
}

void pairs(benchmark::State& state, std::size_t a_round) {
  state.counters["pairs/s"] = benchmark::Counter(static_cast<double>(a_round * state.iterations()),
                                                 benchmark::Counter::kIsRate, benchmark::Counter::kIs1000);
}

void BM_Look(benchmark::State& state) {
  const std::vector<PreparedView> views = prepare(scan(), 0, scan().views.size());
  const auto points = blocks(64);
  for (auto _ : state) {
    for (const auto& block : points)
      for (const PreparedView& view : views) benchmark::DoNotOptimize(look(view, PointBlock(block)));
  }
  pairs(state, 64 * 512 * kViews);
}
BENCHMARK(BM_Look);

void BM_Testify(benchmark::State& state) {
  const std::vector<PreparedView> views = prepare(scan(), 0, scan().views.size());
  const LikelihoodRatio ratio(scan().sensor);
  const auto points = blocks(64);
  std::vector<BlockLook> looks;
  for (const auto& block : points)
    for (const PreparedView& view : views) looks.push_back(look(view, PointBlock(block)));
  for (auto _ : state) {
    for (std::size_t i = 0; i < looks.size(); ++i)
      benchmark::DoNotOptimize(testify(views[i % kViews], ratio, 0.25f, looks[i], 512));
  }
  pairs(state, 64 * 512 * kViews);
}
BENCHMARK(BM_Testify);

void BM_Accumulate(benchmark::State& state) {
  const VisibilityIntegral integral(0.5, 0.0, kViews);
  BlockTestimony said;
  Random random(1);
  for (std::size_t i = 0; i < 512; ++i)
    said.log_ratio[i] = static_cast<float>(random.uniform(-6, 6)), said.share[i] = 1;
  std::vector<float> sums(512 * static_cast<std::size_t>(integral.nodeCount()));
  for (auto _ : state) {
    accumulate(integral, said, 1e-6f, 512, sums.data());
    benchmark::ClobberMemory();
  }
  pairs(state, 512);
}
BENCHMARK(BM_Accumulate);

void BM_Evidence(benchmark::State& state) {
  const ThreadLimit one(1);
  std::vector<Eigen::Vector3d> points;
  for (const auto& block : blocks(512)) points.insert(points.end(), block.begin(), block.end());
  for (auto _ : state) benchmark::DoNotOptimize(evidenceAt(scan(), points, {}));
  pairs(state, points.size() * kViews);
}
BENCHMARK(BM_Evidence)->Unit(benchmark::kMillisecond);

// The inside of a hollow sphere, walked through: each view sees a part of the wall and is skipped elsewhere.
// Pairs count whether skipped or not.
void BM_EvidenceOfARoom(benchmark::State& state) {
  const ThreadLimit one(1);
  constexpr int kSteps = 96;
  static const JudgedViews room = [] {
    constexpr double kRoom = 0.5;
    std::vector<View> views;
    const Pinhole camera{640, 480, 525, 525, 319.5, 239.5, {}};
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d eye = 0.2 * test::fibonacciDirection(i, kSteps);
      views.push_back(test::castView(eye, -eye, camera, [](const auto& origin, const auto& direction) {
        const double b = origin.dot(direction);
        return -b + std::sqrt(b * b - origin.squaredNorm() + kRoom * kRoom);
      }));
    }
    test::addNoise(views, {0.002, 0, 0}, 1);
    return believe(std::move(views), {gaussianNoise(), {0.002, 0, 0}, 0.1, 1.0}, 0.01);
  }();
  std::vector<Eigen::Vector3d> points;
  for (const auto& block : blocks(512)) points.insert(points.end(), block.begin(), block.end());
  for (auto _ : state) benchmark::DoNotOptimize(evidenceAt(room, points, {}));
  pairs(state, points.size() * kSteps);
}
BENCHMARK(BM_EvidenceOfARoom)->Unit(benchmark::kMillisecond);

// What the memory gives: a pair of the evidence must read a depth and an outlier probability.
void BM_Copy(benchmark::State& state) {
  std::vector<char> from(64 << 20), to(64 << 20);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(from.size()) * state.iterations());
}
BENCHMARK(BM_Copy)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace vdbfuse

BENCHMARK_MAIN();
