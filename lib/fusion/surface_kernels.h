// SPDX-License-Identifier: Apache-2.0
// PixelSurface of the rows of an undistorted pinhole's image, for the best instruction set of the machine.
#pragma once

#include <array>
#include <vector>

#include "fusion/noise_curve.h"
#include "fusion/packed_normal.h"
#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// PixelSurface of one row, by component.
struct SurfaceRow {
  explicit SurfaceRow(int row_width)
      : width(row_width), x(padded()), y(padded()), z(padded()), incidence(padded()), continuity(padded()) {}

  static constexpr int kLanes = 16;  ///< vectors reach no further than this past the end
  std::size_t padded() const { return static_cast<std::size_t>(width + kLanes); }

  int width;
  std::vector<float> x, y, z;  ///< of the normal
  std::vector<float> incidence, continuity;
};

/// Some rows of depths and of their inverses with zeros around, so that neighbourhoods need no care at the
/// border.
class PaddedDepth {
 public:
  static constexpr int kRadius = 2;

  /// For neighbourhoods of the pixels of rows [begin, end).
  PaddedDepth(const Image<float>& depth, int begin, int end);

  /// From pixel 0 on; kRadius pixels before it and above and below the rows can be read, too.
  const float* depth(int y) const { return depth_.row(y - begin_ + kRadius) + kRadius; }
  const float* inverse(int y) const { return inverse_.row(y - begin_ + kRadius) + kRadius; }

 private:
  int begin_;
  Image<float> depth_, inverse_;
};

struct PinholeSurface {
  float fx, fy, cx, cy;
  /// Depths that differ by no more than this curve, plus slope·d a pixel, belong to one surface.
  NoiseCurve reach;
  float slope;
  std::array<std::array<float, 3>, 3> world_from_camera;
};

/// A normal needs so many neighbours; fewer that are measured count as so many.
inline constexpr int kLeastSurfaceNeighbours = 6;

void analyseRow(const PinholeSurface& surface, const PaddedDepth& depth, int y, SurfaceRow& row);

/// The normals of a row, row.width of them.
void packNormals(const SurfaceRow& row, PackedNormal* packed);

}  // namespace vdbfuse
