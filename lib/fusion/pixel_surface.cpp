// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/pixel_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <variant>

#include "fusion/surface_rows.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/distortion.h"

namespace vdbfuse {
namespace {

constexpr int kRadius = PaddedDepth::kRadius;
constexpr double kSteepestSlope = 2.75;                // tan 70°
constexpr double kSigmas = 3.0 * std::numbers::sqrt2;  // between two measurements

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
  SurfaceAnalysis(const View& view, const NoiseLaw& noise)
      : view_(view), noise_(noise), depth_(view.map.depth) {}

  LocalSurface analyse(int x, int y) const {
    LocalSurface result;
    const float d = depth_(x, y);
    if (d == kInvalidDepth) return result;
    PlaneSums sums;
    sums.add(0, 0, inverse(x, y));
    gather(x, y, sums);
    const int neighbours = sums.count - 1;
    result.continuity =
        static_cast<float>(neighbours) / static_cast<float>(std::max(sums.valid, kLeastSurfaceNeighbours));
    if (neighbours < kLeastSurfaceNeighbours) return result;
    const auto plane = sums.solve();
    if (!plane) return result;
    if (const auto normal = cameraNormal(x, y, *plane)) setNormal(x, y, *normal, result);
    return result;
  }

 private:
  double inverse(int x, int y) const { return 1.0 / depth_(x, y); }

  void gather(int x, int y, PlaneSums& sums) const {
    const float d = depth_(x, y);
    const float noise = static_cast<float>(kSigmas * noise_.at(d));
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
};

// Any projection, a pixel at a time.
void analyseRow(const SurfaceAnalysis& analysis, int y, SurfaceRow& row) {
  for (int x = 0; x < row.width; ++x) {
    const LocalSurface local = analysis.analyse(x, y);
    const auto i = static_cast<std::size_t>(x);
    row.x[i] = local.normal.x(), row.y[i] = local.normal.y(), row.z[i] = local.normal.z();
    row.incidence[i] = local.incidence, row.continuity[i] = local.continuity;
  }
}

PinholeSurface prepare(const Pinhole& camera, const View& view, const NoiseLaw& noise) {
  const auto in_single = [](double value) { return static_cast<float>(value); };
  PinholeSurface surface{in_single(camera.fx),
                         in_single(camera.fy),
                         in_single(camera.cx),
                         in_single(camera.cy),
                         NoiseCurve(noise * kSigmas),
                         in_single(kSteepestSlope * footprint(camera, 1.0)),
                         {}};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      surface.world_from_camera[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] =
          in_single(view.world_from_camera.linear()(r, c));
  }
  return surface;
}

// Calls analyse(y, row) and visit(y, row) for rows [begin, end).
template <class Analyse, class Visit>
void visitRows(int width, int begin, int end, const Analyse& analyse, const Visit& visit) {
  SurfaceRow row(width);
  for (int y = begin; y < end; ++y) analyse(y, row), visit(y, row);
}

}  // namespace

void forEachSurfaceRow(const View& view, const NoiseLaw& noise,
                       const std::function<void(int y, const SurfaceRow& row)>& visit) {
  const Image<float>& depth = view.map.depth;
  const Pinhole* camera = std::get_if<Pinhole>(&view.projection);
  if (camera != nullptr && isDistorted(*camera)) camera = nullptr;
  const std::optional<PinholeSurface> surface =
      camera == nullptr ? std::nullopt : std::optional(prepare(*camera, view, noise));
  const SurfaceAnalysis analysis(view, noise);
  parallelFor(static_cast<std::size_t>(depth.height()), 16, [&](std::size_t first, std::size_t last) {
    const auto begin = static_cast<int>(first), end = static_cast<int>(last);
    if (!surface) {
      visitRows(
          depth.width(), begin, end, [&](int y, SurfaceRow& row) { analyseRow(analysis, y, row); }, visit);
      return;
    }
    const PaddedDepth padded(depth, begin, end);
    visitRows(
        depth.width(), begin, end, [&](int y, SurfaceRow& row) { analyseRow(*surface, padded, y, row); },
        visit);
  });
}

PixelSurface analyseSurface(const View& view, const NoiseLaw& noise) {
  const int width = view.map.depth.width(), height = view.map.depth.height();
  PixelSurface result{Image<Eigen::Vector3f>(width, height, Eigen::Vector3f::Zero()),
                      Image<float>(width, height), Image<float>(width, height)};
  forEachSurfaceRow(view, noise, [&](int y, const SurfaceRow& row) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(x);
      result.normal(x, y) = {row.x[i], row.y[i], row.z[i]};
    }
    std::copy_n(row.incidence.begin(), width, result.incidence.row(y));
    std::copy_n(row.continuity.begin(), width, result.continuity.row(y));
  });
  return result;
}

Eigen::Vector3f surfaceNormal(const View& view, const NoiseLaw& noise, int x, int y) {
  return SurfaceAnalysis(view, noise).analyse(x, y).normal;
}

}  // namespace vdbfuse
