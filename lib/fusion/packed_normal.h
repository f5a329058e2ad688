// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vdbfuse {

/// A unit vector in four bytes, by its place on an octahedron: to 1e-4 radians. Or none.
class PackedNormal {
 public:
  PackedNormal() = default;
  /// Of a unit vector; of zero: none.
  explicit PackedNormal(const Eigen::Vector3f& normal) {
    const float sum = normal.cwiseAbs().sum();
    if (!(sum > 0)) return;
    Eigen::Vector2f place = normal.head<2>() / sum;
    if (normal.z() < 0) place = folded(place);
    x_ = stored(place.x()), y_ = stored(place.y());
  }

  bool isNone() const { return x_ == kNone; }
  /// Zero when there is none.
  Eigen::Vector3f unpack() const { return isNone() ? Eigen::Vector3f::Zero() : direction().normalized(); }
  /// Along the normal, not of unit length. REQUIRES: there is one.
  Eigen::Vector3f direction() const {
    Eigen::Vector2f place(static_cast<float>(x_) / kLargest, static_cast<float>(y_) / kLargest);
    const float z = 1 - place.cwiseAbs().sum();
    if (z < 0) place = folded(place);
    return {place.x(), place.y(), z};
  }

 private:
  static constexpr float kLargest = 32767;
  static constexpr std::int16_t kNone = -32768;

  static std::int16_t stored(float value) {
    return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * kLargest));
  }
  // The lower half of the octahedron covers the corners of the square.
  static Eigen::Vector2f folded(const Eigen::Vector2f& place) {
    return {std::copysign(1 - std::abs(place.y()), place.x()),
            std::copysign(1 - std::abs(place.x()), place.y())};
  }

  std::int16_t x_ = kNone, y_ = kNone;
};

}  // namespace vdbfuse
