// SPDX-License-Identifier: Apache-2.0
// The inner loops over the rows of a depth map, for the best instruction set of the machine.
#pragma once

#include <array>
#include <cstdint>

#include "fusion/depth_edges.h"

namespace vdbfuse {

/// A row of a depth map, with one above and one below.
struct DepthRows {
  const float *above, *here, *below;
  int width;
};

/// Sets the bits of pixels where nothing was measured, and of those whose depth jumps to one of the four
/// neighbours. Bits are 0 before; rows above and below are the next ones, or the row itself.
void markEdges(const DepthRows& rows, const DepthEdge& edge, std::uint64_t* missing, std::uint64_t* jumps);

/// What a pixel's weight is the product of; see measurement_weight.h.
struct RowWeighting {
  bool has_noise = false;
  float constant = 0, linear = 0,
        quadratic = 0;  ///< s = constant + linear·z + quadratic·z², z not below `vertex`
  float vertex = 0;
  float half_voxel_squared = 0;

  /// Of a pinhole: rays are (us[x], v, 1); differences of 1/z over `radius` pixels to either side times these
  /// are its derivatives. Cosine kUnknownCosine where the four neighbours at that distance differ by more
  /// than jump·z.
  const float* us = nullptr;  ///< null: no incidence
  int radius = 0;
  float v = 0, per_x = 0, per_y = 0, jump = 0;

  /// Bits of EdgeBands, and the weight there; null: no silhouette.
  std::array<const std::uint64_t*, 3> bands{};
  std::array<float, 3> ramp{};
};

inline constexpr float kUnknownCosine = 0.5f;

/// The weights of a row. `rows`: at `radius` above and below. REQUIRES for an incidence: radius ≤ y < height
/// − radius.
void weighRow(const DepthRows& rows, const RowWeighting& weighting, float* weights);

}  // namespace vdbfuse
