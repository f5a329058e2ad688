// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/agreement.h"

#include <algorithm>
#include <cmath>

#include "fusion/prepared_view.h"
#include "fusion/touched_leaves.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/sensor/view.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

// Pixels less reliable than this make no leaves of their own: an outlier must not size the grid.
constexpr float kMaxOutlierOfSeeds = 0.5f;
// The kernel is cut off at this many widths.
constexpr double kKernelReach = 2.0;

void addView(const PreparedView& prepared, const GridFrame& frame, const ScalarGrid::Leaf& leaf) {
  const JudgedView& view = *prepared.view;
  for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
    const Index3 voxel = leaf.origin + leafOffset(k);
    const std::optional<Sighting> seen = prepared.projector(frame.toWorld(voxel));
    if (!seen) continue;
    const float depth = view.depth(seen->x, seen->y);
    if (depth == kInvalidDepth) continue;
    const double width = std::max<double>(frame.voxel, prepared.noise.at(depth));
    const double r = std::abs(depth - seen->depth) / width;
    if (r > kKernelReach) continue;
    leaf.values[static_cast<std::size_t>(k)] +=
        static_cast<float>(view.weight * (1.0 - view.outlier(seen->x, seen->y)) * std::exp(-r * r));
  }
}

}  // namespace

ScalarGrid countAgreement(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                          const Progress& progress) {
  const std::vector<PreparedView> views = prepare(judged);
  const TouchOptions touch{kMaxOutlierOfSeeds,
                           [&](double noise) { return kKernelReach * std::max(frame.voxel, noise); }};
  ScalarGrid support("support", frame, 0.0f, touchedLeaves(views, frame, domain, touch, progress));
  ProgressStep step(progress, "count agreement", support.leafCount());
  support.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (const PreparedView& view : views) addView(view, frame, leaf);
    step.advance();
  });
  support.metadata()["about"] = "C(x): number of reliable views that agree on a surface here";
  return support;
}

ScalarGrid discontinuityCost(const ScalarGrid& support, double mu) {
  std::vector<Index3> origins;
  for (std::size_t i = 0; i < support.leafCount(); ++i) origins.push_back(support.leaf(i).origin);
  ScalarGrid rho("rho", support.frame(), 1.0f, std::move(origins));
  for (std::size_t i = 0; i < support.leafCount(); ++i) {
    const auto counts = support.leaf(i).values;
    const auto costs = rho.leaf(i).values;
    std::transform(counts.begin(), counts.end(), costs.begin(),
                   [mu](float c) { return static_cast<float>(std::exp(-mu * c)); });
  }
  rho.metadata()["about"] = "rho(x) = exp(-mu C(x)), discontinuity cost (Hernandez et al. 2007, eq. 3)";
  rho.metadata()["mu"] = std::to_string(mu);
  return rho;
}

}  // namespace vdbfuse
