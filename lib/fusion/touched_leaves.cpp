// SPDX-License-Identifier: Apache-2.0
#include "fusion/touched_leaves.h"

#include <algorithm>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

std::vector<Index3> touchedByView(const PreparedView& prepared, const GridFrame& frame, const Box& domain,
                                  const TouchOptions& options) {
  const JudgedView& view = *prepared.view;
  std::vector<Index3> origins;
  for (int y = 0; y < view.depth.height(); ++y) {
    for (int x = 0; x < view.depth.width(); ++x) {
      const float depth = view.depth(x, y);
      if (depth == kInvalidDepth || view.outlier(x, y) > options.max_outlier) continue;
      const Eigen::Vector3d point = view.world_from_camera * unproject(view.projection, x, y, depth);
      if (!domain.contains(point)) continue;
      const double reach = options.reach(prepared.noise.at(depth)) / frame.voxel;
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
    if (y % 16 == 15) sortUniqueOrigins(origins);
  }
  sortUniqueOrigins(origins);
  return origins;
}

}  // namespace

std::vector<Index3> touchedLeaves(const std::vector<PreparedView>& views, const GridFrame& frame,
                                  const Box& domain, const TouchOptions& options, const Progress& progress) {
  std::vector<std::vector<Index3>> parts(views.size());
  ProgressStep step(progress, "allocate grid", views.size());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    parts[i] = touchedByView(views[i], frame, domain, options);
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
