// SPDX-License-Identifier: Apache-2.0
// The inner loops of TSDF integration on a leaf of 8³ voxels, for the best instruction set of the machine.
#pragma once

#include <array>
#include <cstdint>

#include "fusion/depth_edges.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {

inline constexpr std::size_t kTsdfLeaf = 512;

/// Where one sensor sees the voxels of a leaf, in the order of leafOffset().
struct LeafSight {
  alignas(64) std::array<float, kTsdfLeaf> u, v;  ///< pixels, may lie outside the image
  alignas(
      64) std::array<float, kTsdfLeaf> depth;  ///< of the voxel, in the sensor's own measure; ≤ 0: not seen
};

/// Of the voxel at the leaf's origin plus leafOffset(i)·voxel, for the rows of Projector::rowsFrom(origin).
void sightLeaf(const PinholeRows& camera, float voxel, LeafSight& sight);

/// What a pixel says: the two numbers that are always looked up together.
struct DepthPixel {
  float depth;   ///< kInvalidDepth: nothing
  float weight;  ///< a multiple of the storage's quantum; 0: nothing
};

/// A depth map as the kernels read it.
struct DepthPixels {
  const float* depth = nullptr;    ///< the same depths once more, side by side
  const DepthPixel* at = nullptr;  ///< width·height of them, and one more that says nothing
  int width = 0, height = 0;
  DepthEdge edge;  ///< cells whose corners differ by more are not interpolated in
};

/// How measurements change voxels.
struct TsdfUpdate {
  float truncation = 0.0f;
  float sign = 1.0f;  ///< −1: take a view out again
  /// In a leaf with voxels in the band those up to so far before a measurement count as the truncation before
  /// it.
  float furthest_before = 0.0f;
  float least_weight = 0.0f;  ///< half a quantum: what weighs less after a removal is nothing
};

struct LeafChange {
  int in_band = 0;  ///< voxels within the truncation of a measurement; 0: nothing was changed
  int before = 0;   ///< voxels further before it
};

/// Voxels hold (mean distance, weight) in single precision.
LeafChange updateLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                      float* voxels);

/// Voxels hold (mean distance / truncation · kHalfOne, weight · kHalfWeight) in 16 bits; the weight stops at
/// kHalfMost.
inline constexpr float kHalfOne = 32767.0f, kHalfWeight = 64.0f, kHalfMost = 32767.0f / kHalfWeight;
LeafChange updateLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                      std::int16_t* voxels);

/// Voxels that hold something and lie further than update.furthest_before before a measurement count as the
/// truncation before it. Returns how many.
int carveLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update, float* voxels);
int carveLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
              std::int16_t* voxels);

/// How much a voxel's colour counts: by its measurement's weight, less with the distance from it, since off
/// the surface oblique rays meet it beside the voxel; 0 beyond `reach`. Multiples of 1/kColorWeight.
void colorWeights(const LeafSight& sight, const DepthPixels& pixels, float reach, float* weights);

inline constexpr float kColorOne = 256.0f, kColorWeight = 64.0f;

/// A picture as the kernels read it, with pixels r + 256 g + 65536 b.
struct ColorPixels {
  const std::uint32_t* rgb = nullptr;
  int width = 0, height = 0;
};

/// Voxels hold (r, g, b) · kColorOne and weight · kColorWeight in 16 bits. `sight`: of the picture's sensor.
/// `weight`: of each voxel, 0 where the picture is not to be looked at.
void updateColors(const LeafSight& sight, const ColorPixels& pixels, const float* weight, float sign,
                  std::uint16_t* voxels);

}  // namespace vdbfuse
