// SPDX-License-Identifier: Apache-2.0
#include "fusion/depth_edges.h"

#include "fusion/weight_kernels.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {

DepthEdge depthEdge(const Projection& projection, double voxel) {
  constexpr double kSteps = 8;  // √2 tan 80° footprints
  const double none = footprint(projection, 0.0);
  return {static_cast<float>(kSteps * (footprint(projection, 1.0) - none)),
          static_cast<float>(kSteps * none + voxel)};
}

EdgeBands edgeBands(const Image<float>& depth, const DepthEdge& edge) {
  constexpr std::size_t kRowsPerTask = 32;
  const int width = depth.width(), height = depth.height();
  BitImage missing(width, height), at(width, height), lone(width, height);
  parallelFor(static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const DepthRows rows{y > 0 ? depth.row(y - 1) : nullptr, depth.row(y),
                           y + 1 < height ? depth.row(y + 1) : nullptr, width};
      markEdges(rows, edge, {missing.row(y), at.row(y), lone.row(y)});
    }
  });
  // From the middle of a patch one step leads to its rim, and another beside it.
  const BitImage beside_patch = grown(grown(shrunk(missing)));
  for (int y = 0; y < height; ++y)
    for (std::size_t w = 0; w < at.words(); ++w) at.row(y)[w] |= beside_patch.row(y)[w];
  BitImage one = grown(at), two = grown(one);
  return {std::move(at), std::move(one), std::move(two), std::move(lone)};
}

}  // namespace vdbfuse
