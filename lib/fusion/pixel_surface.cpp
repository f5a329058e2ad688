// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/pixel_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr int kRadius = 2;
constexpr int kMinNeighbours = 6;
constexpr double kSteepestSlope = 2.75;  // tan 70°

// Sums of the least-squares plane w = a + b·dx + c·dy in inverse depth.
struct PlaneSums {
  int count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  double w = 0, xw = 0, yw = 0;
  int valid = 0;  // neighbours with a depth, whether they continue the surface or not

  void add(int dx, int dy, double inverse_depth) {
    ++count, x += dx, y += dy, xx += dx * dx, xy += dx * dy, yy += dy * dy;
    w += inverse_depth, xw += dx * inverse_depth, yw += dy * inverse_depth;
  }
  // (a, b, c); nothing when the pixels lie on a line.
  std::optional<Eigen::Vector3d> solve() const {
    const double n = count,
                 determinant = n * (xx * yy - xy * xy) - x * (x * yy - xy * y) + y * (x * xy - xx * y);
    if (determinant == 0) return std::nullopt;
    const double aa = xx * yy - xy * xy, ab = y * xy - x * yy, ac = x * xy - y * xx;
    const double bb = n * yy - y * y, bc = x * y - n * xy, cc = n * xx - x * x;
    return Eigen::Vector3d(aa * w + ab * xw + ac * yw, ab * w + bb * xw + bc * yw,
                           ac * w + bc * xw + cc * yw) /
           determinant;
  }
};

// What is found out about one pixel.
struct LocalSurface {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float incidence = 0, continuity = 0;
};

class SurfaceAnalysis {
 public:
  // `inverse`: 1/d of all pixels, or empty where only a few are asked for.
  SurfaceAnalysis(const View& view, const NoiseLaw& noise, const Image<float>& inverse)
      : view_(view), noise_(noise), depth_(view.map.depth), inverse_(inverse) {}

  LocalSurface analyse(int x, int y) const {
    LocalSurface result;
    const float d = depth_(x, y);
    if (d == kInvalidDepth) return result;
    PlaneSums sums;
    sums.add(0, 0, inverse(x, y));
    gather(x, y, sums);
    const int neighbours = sums.count - 1;
    result.continuity =
        static_cast<float>(neighbours) / static_cast<float>(std::max(sums.valid, kMinNeighbours));
    if (neighbours < kMinNeighbours) return result;
    const auto plane = sums.solve();
    if (!plane) return result;
    if (const auto normal = cameraNormal(x, y, *plane)) setNormal(x, y, *normal, result);
    return result;
  }

 private:
  float inverse(int x, int y) const { return inverse_.empty() ? 1.0f / depth_(x, y) : inverse_(x, y); }

  void gather(int x, int y, PlaneSums& sums) const {
    const float d = depth_(x, y);
    const float noise = static_cast<float>(3.0 * std::numbers::sqrt2 * noise_.at(d));
    const float slope = static_cast<float>(kSteepestSlope * footprint(view_.projection, d));
    const int left = std::max(0, x - kRadius), right = std::min(depth_.width() - 1, x + kRadius);
    const int top = std::max(0, y - kRadius), bottom = std::min(depth_.height() - 1, y + kRadius);
    for (int v = top; v <= bottom; ++v) {
      for (int u = left; u <= right; ++u) {
        const float other = depth_(u, v);
        const int dx = u - x, dy = v - y, steps = std::max(std::abs(dx), std::abs(dy));
        if (other == kInvalidDepth || steps == 0) continue;
        ++sums.valid;
        if (std::abs(other - d) <= noise + slope * static_cast<float>(steps)) sums.add(dx, dy, inverse(u, v));
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

  void setNormal(int x, int y, const Eigen::Vector3d& normal, LocalSurface& out) const {
    const double cosine = -normal.dot(rayDirection(view_.projection, x, y, depth_(x, y)));
    const double sign = cosine < 0 ? -1.0 : 1.0;
    out.normal = (view_.world_from_camera.linear() * normal * sign).cast<float>();
    out.incidence = static_cast<float>(std::abs(cosine));
  }

  const View& view_;
  const NoiseLaw& noise_;
  const Image<float>& depth_;
  const Image<float>& inverse_;
};

}  // namespace

PixelSurface analyseSurface(const View& view, const NoiseLaw& noise) {
  const int width = view.map.depth.width(), height = view.map.depth.height();
  PixelSurface result{Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero()),
                      Image<float>(width, height), Image<float>(width, height)};
  Image<float> inverse(width, height);
  std::transform(view.map.depth.begin(), view.map.depth.end(), inverse.begin(),
                 [](float d) { return d > 0 ? 1.0f / d : 0.0f; });
  const SurfaceAnalysis analysis(view, noise, inverse);
  parallelFor(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        const LocalSurface local = analysis.analyse(x, y);
        result.normal(x, y) = local.normal;
        result.incidence(x, y) = local.incidence;
        result.continuity(x, y) = local.continuity;
      }
    }
  });
  return result;
}

Eigen::Vector3f surfaceNormal(const View& view, const NoiseLaw& noise, int x, int y) {
  return SurfaceAnalysis(view, noise, {}).analyse(x, y).normal;
}

}  // namespace vdbfuse
