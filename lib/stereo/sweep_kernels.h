// SPDX-License-Identifier: Apache-2.0
// The inner loop of stereo: correlates every window of a tile with a partner's picture at one inverse depth
// after the other. Written once for each instruction set; the best one is chosen at run time.
//
// A window's pixels are moved each by its own inverse depth, w(x) + offset, so that the window lies on the
// surface that `w` describes (Collins 1996 for planes; here any). The sums over a window are running sums of
// whole numbers: they cost the same for any window, and come out the same whatever tile they are part of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include "stereo/picture_pyramid.h"

namespace vdbfuse::stereo {

/// Memory that begins where a widest vector may.
template <class T>
struct VectorAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): as std::allocator_traits asks for
  static constexpr std::align_val_t kAlignment{64};
  VectorAllocator() = default;
  template <class U>
  VectorAllocator(const VectorAllocator<U>&) {}  // NOLINT: a rebind
  T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kAlignment)); }
  void deallocate(T* values, std::size_t) { ::operator delete(values, kAlignment); }
  bool operator==(const VectorAllocator&) const = default;
};
using AlignedFloats = std::vector<float, VectorAllocator<float>>;
using AlignedInts = std::vector<std::int32_t, VectorAllocator<std::int32_t>>;

/// Where the pixel (x, y) of the reference is seen in the partner at inverse depth w: a·(x, y, 1) + w·b,
/// homogeneous.
struct ImageMotion {
  std::array<float, 9> a{};
  std::array<float, 3> b{};
};

/// Between two levels of the same or of different size.
ImageMotion imageMotion(const Pinhole& reference, const RigidTransform& world_from_reference,
                        const Pinhole& partner, const RigidTransform& world_from_partner);

/// A rectangle of the reference with all that its windows need. Rows of the images with a margin begin at
/// (x0 − radius, y0 − radius).
struct SweepTile {
  int x0 = 0, y0 = 0, width = 0, height = 0;
  int radius = 3;
  int stride = 0;  ///< of all rows below: width + 2 radius, rounded up to whole vectors
  /// With margin: u(x, y) | −u(x, y − window) << 16, 0 for what is above the margin.
  AlignedInts products;
  /// With margin: w.
  AlignedFloats base;
  /// Without margin: mean brightness, and 1/√(Σ(u − mean)²) of the windows; 0 where there is no window.
  AlignedFloats mean, inverse_spread;

  int window() const { return 2 * radius + 1; }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(stride) + static_cast<std::size_t>(x);
  }
};

inline constexpr int kVectorLanes = 16;  ///< rows are multiples of the widest vector

/// Local maxima of the curve S(k) of one partner, k counting steps: the best one of every pixel. Arrays
/// without margin, strides of the tile.
struct BestPeaks {
  AlignedFloats score;      ///< kNoPeak where there is none
  AlignedFloats step;       ///< by a parabola through three samples
  AlignedFloats curvature;  ///< −(S(k − 1) − 2 S(k) + S(k + 1))
};
inline constexpr float kNoPeak = -1.0F;

/// All local maxima of all partners, at most kMostPeaks a pixel and partner (the best ones).
inline constexpr int kMostPeaks = 6;
struct PeakLists {
  std::size_t pixels = 0;
  std::vector<std::uint8_t> counts;  ///< partner · pixels + pixel
  /// (partner · kMostPeaks + number) · pixels + pixel; the score is kNoPeak beyond the count.
  AlignedFloats step, score;

  /// Empty lists for a tile.
  void clear(const SweepTile& tile, std::size_t partners);
};

/// The inverse depths that a tile is swept over: w(x) + first + k·step, 0 ≤ k < count.
struct SweepRange {
  float first = 0, step = 0;
  int count = 0;
};

/// Memory of a sweep, for the next one.
struct SweepMemory {
  AlignedInts ring, valid, columns, index, weights, texels;
  AlignedFloats curve[3];
};

/// What a sweep looks for.
struct SweepLimits {
  float threshold = 0.5F;   ///< least score of a peak
  float least_spread2 = 1;  ///< least Σ(v − mean)² of a partner's window
};

/// Replaces `peaks` by those of this partner.
void sweepForBest(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
                  const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, BestPeaks& peaks);

/// Adds the peaks of partner number `index`.
void sweepForAll(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
                 const SweepRange& range, const SweepLimits& limits, std::size_t index, SweepMemory& memory,
                 PeakLists& peaks);

}  // namespace vdbfuse::stereo
