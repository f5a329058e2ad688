// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/domain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

constexpr double kPixelsPerView = 20000, kPixels = 4e6;  // the smaller one of many views
// Trust a place needs: so many reliable points, or this share of what places have where most points are.
constexpr double kEnoughPoints = 3.0, kEnoughShare = 0.25;
// Undecided pixels count only where hardly any pixel is decided.
constexpr float kDecided = 0.45f, kUndecided = 0.5f;
constexpr std::size_t kEnoughDecided = 100;
constexpr double kMargin = 0.03;

struct ReliablePoint {
  Eigen::Vector3d position;
  std::uint32_t view;
  float trust;
};

std::vector<ReliablePoint> reliablePoints(const JudgedViews& judged, float max_outlier) {
  std::vector<ReliablePoint> points;
  const double wanted = std::min(kPixelsPerView, kPixels / static_cast<double>(judged.views.size()));
  for (std::size_t i = 0; i < judged.views.size(); ++i) {
    const JudgedView& view = judged.views[i];
    const int stride =
        std::max(1, static_cast<int>(std::sqrt(static_cast<double>(view.depth.size()) / wanted)));
    for (int y = stride / 2; y < view.depth.height(); y += stride) {
      for (int x = stride / 2; x < view.depth.width(); x += stride) {
        const float depth = view.depth(x, y), outlier = view.outlier(x, y);
        if (depth == kInvalidDepth || outlier > max_outlier) continue;
        const Eigen::Vector3d point = view.world_from_camera * unproject(view.projection, x, y, depth);
        points.push_back({point, static_cast<std::uint32_t>(i), 1 - outlier});
      }
    }
    letGo(view);
  }
  return points;
}

// Box that holds most of the points, whatever the others do.
Box roughBox(const std::vector<ReliablePoint>& points) {
  Box box;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [axis](const auto& p) { return p.position[axis]; });
    const auto quantile = [&](double share) {
      const auto nth =
          values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), nth, values.end());
      return *nth;
    };
    const double low = quantile(0.01), high = quantile(0.99);
    box.min()[axis] = low - 0.5 * (high - low), box.max()[axis] = high + 0.5 * (high - low);
  }
  return box;
}

// Side of a place: so large that a view leaves about one point in each place it sees. Smaller places tell
// surfaces from scattered mistakes better, the ones filling places by the square and the others by the cube
// of their side.
double placeSide(const Box& rough, std::size_t points, std::size_t views) {
  const double across = std::sqrt(static_cast<double>(points) / static_cast<double>(views));
  const double places = std::clamp(across, 8.0, 100.0);
  return std::max(rough.sizes().maxCoeff() / places, 1e-9);
}

struct Place {
  double trust = 0;
  std::uint32_t first_view = 0;
  bool several_views = false;
};

// Space cut into cubes, and what the points say of each.
class Places {
 public:
  Places(const std::vector<ReliablePoint>& points, const Box& rough, std::size_t views)
      : low_(rough.min()), side_(placeSide(rough, points.size(), views)), one_view_(views == 1) {
    for (const ReliablePoint& point : points) {
      const auto [entry, is_new] = places_.try_emplace(key(point.position));
      Place& place = entry->second;
      if (is_new) place.first_view = point.view;
      place.several_views |= place.first_view != point.view;
      place.trust += point.trust;
    }
    enough_ = std::min(kEnoughPoints, kEnoughShare * trustWhereMostPointsAre(points));
  }

  bool isSupported(const Eigen::Vector3d& point) const {
    const Place& place = places_.at(key(point));
    return place.trust >= enough_ && (place.several_views || one_view_);
  }

 private:
  std::uint64_t key(const Eigen::Vector3d& point) const {
    const Eigen::Matrix<std::uint64_t, 3, 1> cell = ((point - low_) / side_).cast<std::uint64_t>();
    return cell.x() | cell.y() << 20 | cell.z() << 40;
  }

  double trustWhereMostPointsAre(const std::vector<ReliablePoint>& points) const {
    std::vector<double> trusts;
    for (const ReliablePoint& point : points) trusts.push_back(places_.at(key(point.position)).trust);
    if (trusts.empty()) return 0;
    const auto middle = trusts.begin() + static_cast<std::ptrdiff_t>(trusts.size() / 2);
    std::nth_element(trusts.begin(), middle, trusts.end());
    return *middle;
  }

  Eigen::Vector3d low_;
  double side_;
  bool one_view_;
  double enough_ = 0;
  std::unordered_map<std::uint64_t, Place> places_;
};

}  // namespace

Box supportedDomain(const JudgedViews& judged) {
  std::vector<ReliablePoint> points = reliablePoints(judged, kDecided);
  if (points.size() < kEnoughDecided) points = reliablePoints(judged, kUndecided);
  if (points.empty())
    throw InvalidArgument("views", "no depth is believed by any other view; nothing to reconstruct");
  const Box rough = roughBox(points);
  std::erase_if(points, [&](const ReliablePoint& p) { return !rough.contains(p.position); });
  const Places places(points, rough, judged.views.size());
  Box box;
  for (const ReliablePoint& point : points) {
    if (places.isSupported(point.position)) box.extend(point.position);
  }
  if (box.isEmpty())
    throw InvalidArgument("views", "the views do not overlap: no place is seen by two of them");
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin * box.diagonal().norm());
  return {box.min() - margin, box.max() + margin};
}

void widenRange(JudgedViews& judged, const Box& domain) {
  constexpr int kSteps = 4;  // points along each side of the box: rays through its middle matter too
  SensorModel& sensor = judged.sensor;
  for (const JudgedView& view : judged.views) {
    const RigidTransform camera_from_world = view.world_from_camera.inverse();
    for (int i = 0; i < (kSteps + 1) * (kSteps + 1) * (kSteps + 1); ++i) {
      const Eigen::Array3d share(i % (kSteps + 1), i / (kSteps + 1) % (kSteps + 1),
                                 i / (kSteps + 1) / (kSteps + 1));
      const Eigen::Vector3d point = domain.min().array() + domain.sizes().array() * share / kSteps;
      const std::optional<PixelDepth> seen = project(view.projection, camera_from_world * point);
      if (!seen) continue;
      sensor.near = std::min(sensor.near, 0.97 * seen->depth);
      sensor.far = std::max(sensor.far, 1.03 * seen->depth);
    }
  }
}

}  // namespace vdbfuse
