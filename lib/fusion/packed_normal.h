// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vdbfuse {

/// A unit vector in four bytes, by its place on an octahedron: to 1e-4 radians. Or none.
struct PackedNormal {
  static constexpr float kLargest = 32767;
  static constexpr std::int32_t kNone = -32768;

  PackedNormal() = default;
  /// Of a unit vector; of zero: none.
  explicit PackedNormal(const Eigen::Vector3f& normal) {
    const float sum = normal.cwiseAbs().sum();
    if (!(sum > 0)) return;
    Eigen::Vector2f place = normal.head<2>() / sum;
    if (normal.z() < 0) place = folded(place);
    bits = stored(place.y()) << 16 | (stored(place.x()) & 0xFFFF);
  }

  bool isNone() const { return bits == kNone; }
  /// Zero when there is none.
  Eigen::Vector3f unpack() const { return isNone() ? Eigen::Vector3f::Zero() : direction().normalized(); }
  /// Along the normal, not of unit length. REQUIRES: there is one.
  Eigen::Vector3f direction() const {
    const auto x = static_cast<std::int16_t>(bits & 0xFFFF);
    Eigen::Vector2f place(static_cast<float>(x) / kLargest, static_cast<float>(bits >> 16) / kLargest);
    const float z = 1 - place.cwiseAbs().sum();
    if (z < 0) place = folded(place);
    return {place.x(), place.y(), z};
  }

  /// x in the lower and y in the upper half, times kLargest.
  std::int32_t bits = kNone;

 private:
  static std::int32_t stored(float value) {
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * kLargest));
  }
  // The lower half of the octahedron covers the corners of the square.
  static Eigen::Vector2f folded(const Eigen::Vector2f& place) {
    return {std::copysign(1 - std::abs(place.y()), place.x()),
            std::copysign(1 - std::abs(place.x()), place.y())};
  }
};

}  // namespace vdbfuse
