// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/agreement.h"

#include <algorithm>
#include <cmath>

#include "fusion/prepared_view.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {
namespace {

// Pixels less reliable than this make no leaves of their own: an outlier must not size the grid.
constexpr float kMaxOutlierOfSeeds = 0.5f;
// The kernel is cut off at this many widths.
constexpr double kKernelReach = 2.0;

bool sameOrigin(const Index3& a, const Index3& b) { return a == b; }
bool originBefore(const Index3& a, const Index3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

void sortUnique(std::vector<Index3>& origins) {
  std::sort(origins.begin(), origins.end(), originBefore);
  origins.erase(std::unique(origins.begin(), origins.end(), sameOrigin), origins.end());
}

// Leaves within the kernel's reach of the view's reliable points.
std::vector<Index3> touchedLeaves(const PreparedView& prepared, const GridFrame& frame, const Box& domain) {
  const JudgedView& view = *prepared.view;
  std::vector<Index3> origins;
  for (int y = 0; y < view.depth.height(); ++y) {
    for (int x = 0; x < view.depth.width(); ++x) {
      const float depth = view.depth(x, y);
      if (depth == kInvalidDepth || view.outlier(x, y) > kMaxOutlierOfSeeds) continue;
      const Eigen::Vector3d point = view.world_from_camera * unproject(view.projection, x, y, depth);
      if (!domain.contains(point)) continue;
      const double reach =
          kKernelReach * std::max<double>(frame.voxel, prepared.noise.at(depth)) / frame.voxel;
      const Eigen::Vector3d index = frame.toIndex(point);
      const Index3 low = leafOrigin((index.array() - reach).floor().cast<int>().matrix());
      const Index3 high = leafOrigin((index.array() + reach).ceil().cast<int>().matrix());
      for (int i = low.x(); i <= high.x(); i += 8) {
        for (int j = low.y(); j <= high.y(); j += 8) {
          for (int k = low.z(); k <= high.z(); k += 8) {
            const Index3 origin(i, j, k);
            if (origins.empty() || origins.back() != origin) origins.push_back(origin);
          }
        }
      }
    }
    // Neighbouring rows touch the same leaves: keep the list short.
    if (y % 16 == 15) sortUnique(origins);
  }
  sortUnique(origins);
  return origins;
}

std::vector<Index3> allTouchedLeaves(const std::vector<PreparedView>& views, const GridFrame& frame,
                                     const Box& domain, const Progress& progress) {
  std::vector<std::vector<Index3>> parts(views.size());
  ProgressStep step(progress, "allocate grid", views.size());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    parts[i] = touchedLeaves(views[i], frame, domain);
    step.advance();
  });
  std::vector<Index3> all;
  for (const auto& part : parts) {
    std::vector<Index3> merged;
    std::set_union(all.begin(), all.end(), part.begin(), part.end(), std::back_inserter(merged),
                   originBefore);
    all = std::move(merged);
  }
  return all;
}

void addView(const PreparedView& prepared, const GridFrame& frame, const ScalarGrid::Leaf& leaf) {
  const JudgedView& view = *prepared.view;
  for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
    const Index3 voxel = leaf.origin + Index3(k >> 6, (k >> 3) & 7, k & 7);
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
  ScalarGrid support("support", frame, 0.0f, allTouchedLeaves(views, frame, domain, progress));
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
