// SPDX-License-Identifier: Apache-2.0
#include "fusion/touched_leaves.h"

#include <tbb/parallel_sort.h>

#include <algorithm>

#include "fusion/leaf_keys.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

// Origins as numbers in the order of ScalarGrid's leaves, counted from the lowest leaf of the domain.
class LeafKeys {
 public:
  LeafKeys(const GridFrame& frame, const Box& domain)
      : base_(leafOrigin(frame.toIndex(domain.min()).array().floor().cast<int>().matrix())) {}

  std::uint64_t key(const Index3& origin) const {
    const Index3 place = (origin - base_) / kSide;
    return leafKey(place.x(), place.y(), place.z());
  }
  Index3 origin(std::uint64_t key) const { return base_ + kSide * placeOfLeaf(key); }

 private:
  // A domain is at most 2¹⁷ leaves long (kMaxOctreeSide); as much again on either side is room for the reach.
  static constexpr int kSide = ScalarGrid::kLeafSide;
  Index3 base_;
};

void sortUnique(std::vector<std::uint64_t>& keys) {
  tbb::parallel_sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

// Collects the leaves around points, mostly neighbours of each other.
class LeafCollector {
 public:
  LeafCollector(const PreparedView& prepared, const GridFrame& frame, const Box& domain,
                const TouchOptions& options, const LeafKeys& keys)
      : prepared_(prepared), frame_(frame), domain_(domain), options_(options), keys_(keys) {}

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
        for (int k = low.z(); k <= high.z(); k += 8) found_.add(keys_.key({i, j, k}));
      }
    }
  }
  std::vector<std::uint64_t> take() { return found_.take(); }

 private:
  const PreparedView& prepared_;
  const GridFrame& frame_;
  const Box& domain_;
  const TouchOptions& options_;
  const LeafKeys& keys_;
  LeafKeyCollector found_;
};

std::vector<std::uint64_t> touchedByView(const PreparedView& prepared, const GridFrame& frame,
                                         const Box& domain, const TouchOptions& options,
                                         const LeafKeys& keys) {
  const JudgedView& view = *prepared.view;
  LeafCollector leaves(prepared, frame, domain, options, keys);
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
  }
  return leaves.take();
}

}  // namespace

std::vector<Index3> touchedLeaves(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                                  const TouchOptions& options, const Progress& progress) {
  constexpr std::size_t kViewsAtATime = 64;
  const LeafKeys keys(frame, domain);
  std::vector<std::uint64_t> all;
  ProgressStep step(progress, "allocate grid", judged.views.size());
  for (std::size_t begin = 0; begin < judged.views.size(); begin += kViewsAtATime) {
    std::vector<std::vector<std::uint64_t>> parts(std::min(kViewsAtATime, judged.views.size() - begin));
    parallelFor(parts.size(), 1, [&](std::size_t i, std::size_t) {
      const JudgedView& view = judged.views[begin + i];
      parts[i] = touchedByView(PreparedView(view, judged.sensor), frame, domain, options, keys);
      letGo(view);
      step.advance();
    });
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    sortUnique(all);
  }
  std::vector<Index3> origins;
  origins.reserve(all.size());
  for (const std::uint64_t key : all) origins.push_back(keys.origin(key));
  return origins;
}

}  // namespace vdbfuse
