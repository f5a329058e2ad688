// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/tsdf.h"

#include <algorithm>

#include "fusion/prepared_view.h"
#include "fusion/touched_leaves.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

// Running sums of one view over one leaf.
void addView(const PreparedView& prepared, const GridFrame& frame, double truncation,
             const ScalarGrid::Leaf& sum, const ScalarGrid::Leaf& weight) {
  for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
    const Index3 voxel = sum.origin + leafOffset(k);
    const std::optional<Sighting> seen = prepared.projector(frame.toWorld(voxel));
    if (!seen) continue;
    const float measured = prepared.view->depth(seen->x, seen->y);
    if (measured == kInvalidDepth || measured - seen->depth < -truncation) continue;
    sum.values[static_cast<std::size_t>(k)] +=
        static_cast<float>(std::min(measured - seen->depth, truncation));
    weight.values[static_cast<std::size_t>(k)] += 1.0f;
  }
}

}  // namespace

TsdfVolume integrateTsdf(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                         const TsdfOptions& options, const Progress& progress) {
  if (!(options.truncation > 0)) throw InvalidArgument("truncation", "must be positive");
  const TouchOptions touch{1.0f, 2.0f, [&](double) { return options.truncation; }};
  const std::vector<Index3> leaves = touchedLeaves(judged, frame, domain, touch, progress);
  TsdfVolume volume{ScalarGrid("surface", frame, kUnknown, leaves),
                    ScalarGrid("weight", frame, 0.0f, leaves)};
  ProgressStep step(progress, "integrate", leaves.size() * judged.views.size());
  volume.distance.forEachLeaf([](const ScalarGrid::Leaf& sum) { std::ranges::fill(sum.values, 0.0f); });
  forEachPrepared(judged, [&](const std::vector<PreparedView>& views) {
    parallelFor(leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        for (const PreparedView& view : views)
          addView(view, frame, options.truncation, volume.distance.leaf(i), volume.weight.leaf(i));
      }
      step.advance((end - begin) * views.size());
    });
  });
  parallelFor(leaves.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ScalarGrid::Leaf sum = volume.distance.leaf(i), weight = volume.weight.leaf(i);
      std::transform(sum.values.begin(), sum.values.end(), weight.values.begin(), sum.values.begin(),
                     [](float s, float w) { return w > 0 ? s / w : kUnknown; });
    }
  });
  volume.distance.setKind(GridKind::LevelSet);
  volume.distance.metadata()["about"] = "truncated signed distance (Curless and Levoy 1996), > 0 outside";
  return volume;
}

std::vector<double> untruncatedSum(const JudgedViews& judged, const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> sums(points.size(), 0.0);
  for (const JudgedView& view : judged.views) {
    const PreparedView prepared(view, judged.sensor);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::optional<Sighting> seen = prepared.projector(points[i]);
      if (!seen) continue;
      const float measured = prepared.view->depth(seen->x, seen->y);
      if (measured == kInvalidDepth) continue;
      sums[i] += prepared.view->weight * (measured - seen->depth) / prepared.noise.at(measured);
    }
    letGo(view);
  }
  return sums;
}

}  // namespace vdbfuse
