// SPDX-License-Identifier: Apache-2.0
#include "formats/scan_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbfuse {
namespace {

// Whether the second point lies right of the first one (1), left (-1), or one is missing (0).
int turn(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const double cross = double{a.z()} * b.x() - double{a.x()} * b.z();
  return cross > 0 ? 1 : cross < 0 ? -1 : 0;
}

// The same for below and above.
int descent(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const double slope =
      b.y() * std::hypot(double{a.x()}, double{a.z()}) - a.y() * std::hypot(double{b.x()}, double{b.z()});
  return slope > 0 ? 1 : slope < 0 ? -1 : 0;
}

}  // namespace

Eigen::Vector3f scannedPoint(const Eigen::Vector3d& point) {
  const double size = point.cwiseAbs().maxCoeff();
  if (!point.allFinite() || size == 0 || size > kFarthestPoint)
    return Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  return point.cast<float>();
}

PointImage upright(PointImage points) {
  std::int64_t right = 0, down = 0;
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      if (x > 0) right += turn(points(x - 1, y), points(x, y));
      if (y > 0) down += descent(points(x, y - 1), points(x, y));
    }
  }
  for (int y = 0; right < 0 && y < points.height(); ++y)
    std::reverse(points.row(y), points.row(y) + points.width());
  for (int y = 0; down < 0 && y < points.height() / 2; ++y)
    std::swap_ranges(points.row(y), points.row(y) + points.width(), points.row(points.height() - 1 - y));
  return points;
}

}  // namespace vdbfuse
