// SPDX-License-Identifier: Apache-2.0
// The inner loops over the rows of a depth map, for the best instruction set of the machine.
#pragma once

#include <array>
#include <cstdint>

#include "fusion/depth_edges.h"
#include "fusion/noise_curve.h"

namespace vdbfuse {

/// A row of a depth map, with one above and one below, or null.
struct DepthRows {
  const float *above, *here, *below;
  int width;
};

/// Rows of bits: pixels where nothing was measured; whose depth jumps to one of the four neighbours; to all
/// of those that are measured.
struct EdgeBits {
  std::uint64_t *missing, *jumps, *lone;
};

/// Sets bits, which are 0 before. `rows`: the next ones; null beyond the image.
void markEdges(const DepthRows& rows, const DepthEdge& edge, const EdgeBits& bits);

/// What a pixel's weight is the product of; see measurement_weight.h.
struct RowWeighting {
  bool has_noise = false;
  NoiseCurve noise;
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
  const std::uint64_t* lone = nullptr;  ///< bits of pixels that weigh nothing
};

inline constexpr float kUnknownCosine = 0.5f;

/// The weights of a row. `rows`: at `radius` above and below. REQUIRES for an incidence: radius ≤ y < height
/// − radius.
void weighRow(const DepthRows& rows, const RowWeighting& weighting, float* weights);

}  // namespace vdbfuse
