// SPDX-License-Identifier: Apache-2.0
// Pictures of a plane through a scalar field.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// A plane at right angles to a coordinate axis, in world coordinates.
struct SlicePlane {
  int axis = 2;  ///< 0, 1, 2 for x, y, z
  double value = 0;
};

/// Value at a world point; not a number where nothing is known. Called from several threads at once.
using ScalarField = std::function<double(const Eigen::Vector3d& point)>;

/// Samples `field` on the part of the plane that lies in `box`, square pixels, the longer side `longest`
/// pixels. Axis z: x to the right, y upwards. Axis y: x to the right, z upwards. Axis x: y to the right, z
/// upwards. Throws InvalidArgument for an axis outside 0 … 2, longest ≤ 0 or an empty box.
Image<float> sampleSlice(const ScalarField& field, const Box& box, const SlicePlane& plane, int longest);

enum class SliceColors {
  /// Around zero: positive (outside) blue, negative (inside) red, the zero line black. For σ and signed
  /// distances.
  Signed,
  /// From `low` (dark) to `high` (light). For ρ, depths.
  Sequential,
};

struct SliceOptions {
  SliceColors colors = SliceColors::Signed;
  /// What the ends of the colours stand for; Signed takes −high … high. Empty (low = high): the 2 % and the
  /// 98 % quantile of the values (Signed: the 98 % quantile of their magnitudes).
  double low = 0, high = 0;
};

/// Grey where the value is not a number.
Image<Rgb8> drawSlice(const Image<float>& values, const SliceOptions& options = {});

}  // namespace vdbfuse
