// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/block_kernels.h"
#include "fusion/touched_leaves.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/sensor/view.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

// Pixels less reliable than this make no leaves of their own: an outlier must not size the grid.
constexpr float kMaxOutlierOfSeeds = 0.5f;
constexpr float kLeastAlternativeOfSeeds = 0.2f;

std::vector<Eigen::Vector3d> voxelsOf(const ScalarGrid::Leaf& leaf, const GridFrame& frame) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
    points.push_back(frame.toWorld(Index3(leaf.origin + leafOffset(k))));
  return points;
}

// All views' counts at the voxels of a leaf.
void addViews(const std::vector<PreparedView>& views, const GridFrame& frame, const ScalarGrid::Leaf& leaf) {
  const std::vector<Eigen::Vector3d> voxels = voxelsOf(leaf, frame);
  const PointBlock block(voxels);
  alignas(64) std::array<float, PointBlock::kCapacity> counts;
  std::copy(leaf.values.begin(), leaf.values.end(), counts.begin());
  for (const PreparedView& view : views) {
    if (!view.projector.mightSee(block.centre, block.radius)) continue;
    agree(view, static_cast<float>(frame.voxel), static_cast<float>(view.view->weight), look(view, block),
          block.size, counts.data());
  }
  std::copy_n(counts.begin(), leaf.values.size(), leaf.values.begin());
}

}  // namespace

ScalarGrid countAgreement(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                          const Progress& progress) {
  const TouchOptions touch{kMaxOutlierOfSeeds, kLeastAlternativeOfSeeds,
                           [&](double noise) { return kAgreementReach * std::max(frame.voxel, noise); }};
  ScalarGrid support("support", frame, 0.0f, touchedLeaves(judged, frame, domain, touch, progress));
  ProgressStep step(progress, "count agreement", support.leafCount() * judged.views.size());
  forEachPrepared(judged, [&](const std::vector<PreparedView>& views) {
    support.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
      addViews(views, frame, leaf);
      step.advance(views.size());
    });
  });
  support.metadata()["about"] = "C(x): number of reliable views that agree on a surface here";
  return support;
}

ScalarGrid discontinuityCost(const ScalarGrid& support, double mu, double least) {
  std::vector<Index3> origins;
  for (std::size_t i = 0; i < support.leafCount(); ++i) origins.push_back(support.leaf(i).origin);
  ScalarGrid rho("rho", support.frame(), 1.0f, std::move(origins));
  for (std::size_t i = 0; i < support.leafCount(); ++i) {
    const auto counts = support.leaf(i).values;
    const auto costs = rho.leaf(i).values;
    std::transform(counts.begin(), counts.end(), costs.begin(),
                   [mu, least](float c) { return static_cast<float>(std::max(least, std::exp(-mu * c))); });
  }
  rho.metadata()["about"] =
      "rho(x) = max(least_cost, exp(-mu C(x))), discontinuity cost (Hernandez et al. 2007, eq. 3)";
  rho.metadata()["mu"] = std::to_string(mu);
  rho.metadata()["least_cost"] = std::to_string(least);
  return rho;
}

}  // namespace vdbfuse
