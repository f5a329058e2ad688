// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/pixel_surface.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr int kRadius = 2;
constexpr int kMinNeighbours = 6;
constexpr double kSteepestSlope = 2.75;  // tan 70°

// Sums of the least-squares plane w = a + b·dx + c·dy in inverse depth.
struct PlaneSums {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  int count = 0;
  int valid = 0;  // neighbours with a depth, whether they continue the surface or not
  void add(int dx, int dy, double inverse_depth) {
    const Eigen::Vector3d row(1, dx, dy);
    normal_matrix += row * row.transpose();
    right_side += inverse_depth * row;
    ++count;
  }
};

class SurfaceAnalysis {
 public:
  SurfaceAnalysis(const View& view, const NoiseLaw& noise)
      : view_(view), noise_(noise), depth_(view.map.depth) {}

  void analyse(int x, int y, PixelSurface& out) const {
    const float d = depth_(x, y);
    if (d == kInvalidDepth) return;
    PlaneSums sums;
    sums.add(0, 0, 1.0 / d);
    gather(x, y, sums);
    const int neighbours = sums.count - 1;
    out.continuity(x, y) =
        static_cast<float>(neighbours) / static_cast<float>(std::max(sums.valid, kMinNeighbours));
    if (neighbours < kMinNeighbours) return;
    const Eigen::Vector3d plane = sums.normal_matrix.ldlt().solve(sums.right_side);
    if (const auto normal = cameraNormal(x, y, plane)) setNormal(x, y, *normal, out);
  }

 private:
  void gather(int x, int y, PlaneSums& sums) const {
    const double d = depth_(x, y);
    const double noise = 3.0 * std::numbers::sqrt2 * noise_.at(d);
    const double slope = kSteepestSlope * footprint(view_.projection, d);
    for (int dy = -kRadius; dy <= kRadius; ++dy) {
      for (int dx = -kRadius; dx <= kRadius; ++dx) {
        if ((dx == 0 && dy == 0) || !depth_.contains(x + dx, y + dy)) continue;
        const float other = depth_(x + dx, y + dy);
        const double reach = noise + slope * std::max(std::abs(dx), std::abs(dy));
        if (other == kInvalidDepth) continue;
        ++sums.valid;
        if (std::abs(other - d) <= reach) sums.add(dx, dy, 1.0 / other);
      }
    }
  }

  // Normal from the plane's own points one pixel to each side: exact for a pinhole, good for any projection.
  std::optional<Eigen::Vector3d> cameraNormal(int x, int y, const Eigen::Vector3d& plane) const {
    const auto point = [&](int dx, int dy) {
      return unproject(view_.projection, x + dx, y + dy, 1.0 / (plane[0] + plane[1] * dx + plane[2] * dy));
    };
    const double smallest = plane[0] - std::abs(plane[1]) - std::abs(plane[2]);
    if (!(smallest > 0)) return std::nullopt;
    const Eigen::Vector3d normal = (point(0, 1) - point(0, -1)).cross(point(1, 0) - point(-1, 0));
    const double length = normal.norm();
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    return normal / length;
  }

  void setNormal(int x, int y, const Eigen::Vector3d& normal, PixelSurface& out) const {
    const double cosine = -normal.dot(rayDirection(view_.projection, x, y, depth_(x, y)));
    const double sign = cosine < 0 ? -1.0 : 1.0;
    out.normal(x, y) = (view_.world_from_camera.linear() * normal * sign).cast<float>();
    out.incidence(x, y) = static_cast<float>(std::abs(cosine));
  }

  const View& view_;
  const NoiseLaw& noise_;
  const Image<float>& depth_;
};

}  // namespace

PixelSurface analyseSurface(const View& view, const NoiseLaw& noise) {
  const int width = view.map.depth.width(), height = view.map.depth.height();
  PixelSurface result{Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero()),
                      Image<float>(width, height), Image<float>(width, height)};
  const SurfaceAnalysis analysis(view, noise);
  parallelFor(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) analysis.analyse(x, y, result);
    }
  });
  return result;
}

}  // namespace vdbfuse
