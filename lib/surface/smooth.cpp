// SPDX-License-Identifier: Apache-2.0
#include "surface/smooth.h"

#include <array>
#include <cmath>

namespace vdbfuse {
namespace {

constexpr int kRadius = 2;
using Patch = PaddedBlock<kRadius, kRadius>;
using Weights = std::array<float, 2 * kRadius + 1>;

Weights gaussian(double sigma) {
  Weights weights;
  for (int k = -kRadius; k <= kRadius; ++k)
    weights[static_cast<std::size_t>(k + kRadius)] =
        static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma)));
  return weights;
}

// Along one axis; the axes done before are valid in the block only.
void alongAxis(int axis, const Weights& weights, Patch& patch) {
  const Patch in = patch;
  const int step = axis == 0 ? Patch::kSide * Patch::kSide : axis == 1 ? Patch::kSide : 1;
  Index3 low = Index3::Constant(-kRadius), high = Index3::Constant(8 + kRadius);
  for (int a = 0; a <= axis; ++a) low[a] = 0, high[a] = 8;
  for (int x = low.x(); x < high.x(); ++x) {
    for (int y = low.y(); y < high.y(); ++y) {
      const float* from = &in.values[Patch::place(x, y, low.z())];
      float* to = &patch.at(x, y, low.z());
      for (int z = low.z(); z < high.z(); ++z, ++from, ++to) {
        float sum = 0;
        for (int k = -kRadius; k <= kRadius; ++k)
          sum += weights[static_cast<std::size_t>(k + kRadius)] * from[k * step];
        *to = sum;
      }
    }
  }
}

// Values times weights, and the weights; without weights everything known counts alike.
void loadWeighted(const BlockSet& blocks, const std::vector<float>& values, const std::vector<float>& weights,
                  std::size_t b, Patch& sum, Patch& total) {
  loadPadded(blocks, values.data(), b, kUnknown, sum);
  if (!weights.empty()) loadPadded(blocks, weights.data(), b, 0.0f, total);
  for (std::size_t i = 0; i < sum.values.size(); ++i) {
    const bool is_known = sum.values[i] == sum.values[i];
    const float weight = weights.empty() ? 1.0f : total.values[i];
    total.values[i] = is_known ? weight : 0.0f;
    sum.values[i] = is_known ? weight * sum.values[i] : 0.0f;
  }
}

std::vector<float> smoothedOnce(const BlockSet& blocks, const std::vector<float>& values,
                                const std::vector<float>& weights, double sigma) {
  const Weights kernel = gaussian(sigma);
  std::vector<float> result(values.size());
  forEachBlock(blocks.count(), [&](std::size_t b) {
    Patch sum, total;
    loadWeighted(blocks, values, weights, b, sum, total);
    for (int axis = 0; axis < 3; ++axis) alongAxis(axis, kernel, sum), alongAxis(axis, kernel, total);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const Index3 v = leafOffset(static_cast<int>(i));
      const float weight = total.at(v);
      result[b * kBlockSize + i] = weight > 0 ? sum.at(v) / weight : kUnknown;
    }
  });
  return result;
}

}  // namespace

std::vector<float> smoothed(const BlockSet& blocks, const std::vector<float>& values, double sigma,
                            const std::vector<float>& weights) {
  constexpr double kWidest = 1.1;  // of one pass: more would feel the cut-off
  const int passes = std::max(1, static_cast<int>(std::ceil(sigma * sigma / (kWidest * kWidest) - 1e-9)));
  const double step = sigma / std::sqrt(passes);
  std::vector<float> result = smoothedOnce(blocks, values, weights, step);
  for (int pass = 1; pass < passes; ++pass) result = smoothedOnce(blocks, result, {}, step);
  return result;
}

}  // namespace vdbfuse
