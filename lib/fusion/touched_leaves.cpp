// SPDX-License-Identifier: Apache-2.0
#include "fusion/touched_leaves.h"

#include <algorithm>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

// Collects the leaves around points, mostly neighbours of each other.
class LeafCollector {
 public:
  LeafCollector(const PreparedView& prepared, const GridFrame& frame, const Box& domain,
                const TouchOptions& options)
      : prepared_(prepared), frame_(frame), domain_(domain), options_(options) {}

  void touch(int x, int y, float depth) {
    const JudgedView& view = *prepared_.view;
    const Eigen::Vector3d point = view.world_from_camera * unproject(view.projection, x, y, depth);
    if (!domain_.contains(point)) return;
    const double reach = options_.reach(prepared_.noise.at(depth)) / frame_.voxel;
    const Eigen::Vector3d index = frame_.toIndex(point);
    const Index3 low = leafOrigin((index.array() - reach).floor().cast<int>().matrix());
    const Index3 high = leafOrigin((index.array() + reach).ceil().cast<int>().matrix());
    for (int i = low.x(); i <= high.x(); i += 8) {
      for (int j = low.y(); j <= high.y(); j += 8) {
        for (int k = low.z(); k <= high.z(); k += 8) {
          const Index3 origin(i, j, k);
          if (origins_.empty() || origins_.back() != origin) origins_.push_back(origin);
        }
      }
    }
  }
  void tidy() { sortUniqueOrigins(origins_); }
  std::vector<Index3> take() { return std::move(origins_); }

 private:
  const PreparedView& prepared_;
  const GridFrame& frame_;
  const Box& domain_;
  const TouchOptions& options_;
  std::vector<Index3> origins_;
};

std::vector<Index3> touchedByView(const PreparedView& prepared, const GridFrame& frame, const Box& domain,
                                  const TouchOptions& options) {
  const JudgedView& view = *prepared.view;
  LeafCollector leaves(prepared, frame, domain, options);
  for (int y = 0; y < view.depth.height(); ++y) {
    for (int x = 0; x < view.depth.width(); ++x) {
      if (view.depth(x, y) == kInvalidDepth) continue;
      const float outlier = view.outlier(x, y);
      if (outlier <= options.max_outlier) leaves.touch(x, y, view.depth(x, y));
      for (const DepthAlternative& other : view.alternatives) {
        if (other.depth(x, y) != kInvalidDepth &&
            (1 - outlier) * other.share(x, y) >= options.least_alternative)
          leaves.touch(x, y, other.depth(x, y));
      }
    }
    // Neighbouring rows touch the same leaves: keep the list short.
    if (y % 16 == 15) leaves.tidy();
  }
  leaves.tidy();
  return leaves.take();
}

}  // namespace

std::vector<Index3> touchedLeaves(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                                  const TouchOptions& options, const Progress& progress) {
  std::vector<std::vector<Index3>> parts(judged.views.size());
  ProgressStep step(progress, "allocate grid", judged.views.size());
  parallelFor(judged.views.size(), 1, [&](std::size_t i, std::size_t) {
    parts[i] = touchedByView(PreparedView(judged.views[i], judged.sensor), frame, domain, options);
    letGo(judged.views[i]);
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

}  // namespace vdbfuse
