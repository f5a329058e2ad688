// SPDX-License-Identifier: Apache-2.0
#include "surface/measure.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kBlocksPerTask = 8;
constexpr std::size_t kBlocksPerPass = 16384;
constexpr double kSameSide = 1.5;      // noise widths or voxels: beyond this a view sees another surface
constexpr double kNear = 3.0;          // the same for residuals, noise widths; at least 1.5 voxels
constexpr double kLookupPixels = 0.4;  // error of a depth looked up at the nearest pixel, footprints
constexpr double kSlackPixels = 0.1;   // error of a depth between pixels, footprints
constexpr double kLeastCosine = 0.2;  // incidence of pixels without a normal, and the least that is looked at

// A place where the depth maps are asked.
struct Probe {
  std::uint32_t voxel = 0;  // of the block
  float side = 0;           // +1 outside, −1 inside
  Eigen::Vector3d point;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // outwards
  double distance = 0, weight = 0;                   // weighted sums
};

struct PreparedView {
  const JudgedView* view;
  Projector projector;

  explicit PreparedView(const JudgedView& v)
      : view(&v),
        projector(v.projection, v.world_from_camera),
        rays_meet_(std::holds_alternative<Pinhole>(v.projection) ||
                   std::holds_alternative<Spherical>(v.projection)) {}

  /// How a point that the view sees at `seen` moves in the world when its depth grows by 1.
  Eigen::Vector3d along(const Eigen::Vector3d& point, const PixelDepth& seen) const {
    if (rays_meet_) return (point - view->world_from_camera.translation()) / seen.depth;
    const Eigen::Vector3d further = unproject(view->projection, seen.x, seen.y, seen.depth + 1);
    return view->world_from_camera * further - point;
  }
  /// False only when the view can see no surface at the point with this normal.
  bool mightFace(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    return !rays_meet_ || normal.dot(point - view->world_from_camera.translation()) < 0;
  }

 private:
  bool rays_meet_;
};

int nearestPixel(double x) { return static_cast<int>(x + 0.5); }

// The mean signed distance of a voxel.
class DistanceMeter {
 public:
  DistanceMeter(const SensorModel& sensor, double voxel) : sensor_(sensor), voxel_(voxel) {}

  static bool mightCount(const PreparedView&, const Probe&) { return true; }

  void add(const PreparedView& prepared, const PixelDepth& seen, Probe& probe) const {
    const JudgedView& view = *prepared.view;
    const int x = nearestPixel(seen.x), y = nearestPixel(seen.y);
    const float measured = view.depth(x, y);
    if (measured == kInvalidDepth) return;
    const double distance = measured - seen.depth;
    if (std::abs(distance) > 3 * voxel_ + 3 * sensor_.noise.at(measured)) return;
    const double own = sensor_.noise.at(measured),
                 slack = kLookupPixels * footprint(view.projection, measured);
    const double variance = own * own + slack * slack;
    if (-probe.side * distance > kSameSide * std::max(voxel_, std::sqrt(variance))) return;
    const double cosine = std::max<double>(view.incidence(x, y), kLeastCosine);
    const double weight = view.weight * (1 - view.outlier(x, y)) * cosine * cosine / variance;
    probe.distance += weight * distance * cosine;
    probe.weight += weight;
  }

 private:
  const SensorModel& sensor_;
  double voxel_;
};

// The mean distance of the measurements from a point of the surface, along its normal.
class ResidualMeter {
 public:
  ResidualMeter(const SensorModel& sensor, double voxel) : sensor_(sensor), voxel_(voxel) {}

  static bool mightCount(const PreparedView& view, const Probe& probe) {
    return view.mightFace(probe.point, probe.normal);
  }

  void add(const PreparedView& prepared, const PixelDepth& seen, Probe& probe) const {
    const JudgedView& view = *prepared.view;
    const int x = nearestPixel(seen.x), y = nearestPixel(seen.y);
    const float nearest = view.depth(x, y);
    if (nearest == kInvalidDepth) return;
    const double noise = sensor_.noise.at(nearest);
    const double reach = std::max(1.5 * voxel_, kNear * noise);
    if (std::abs(nearest - seen.depth) > reach / kLeastCosine) return;
    const Eigen::Vector3d along = prepared.along(probe.point, seen);
    const double slope = -probe.normal.dot(along);
    const double cosine = slope / along.norm();
    if (cosine < kLeastCosine) return;  // seen from behind, or hardly
    const double residual = (interpolated(view, seen, nearest, noise) - seen.depth) * slope;
    if (std::abs(residual) > reach) return;
    const double slack = kSlackPixels * footprint(view.projection, nearest);
    const double weight =
        view.weight * (1 - view.outlier(x, y)) * cosine * cosine / (noise * noise + slack * slack);
    probe.distance += weight * residual;
    probe.weight += weight;
  }

 private:
  // Bilinear between four pixels of one surface, else that of the nearest pixel.
  double interpolated(const JudgedView& view, const PixelDepth& seen, float nearest, double noise) const {
    const int x = static_cast<int>(std::floor(seen.x)), y = static_cast<int>(std::floor(seen.y));
    if (x < 0 || y < 0 || x + 1 >= view.depth.width() || y + 1 >= view.depth.height()) return nearest;
    const double limit = 4 * noise + 5 * footprint(view.projection, nearest);
    double depths[4];
    for (int k = 0; k < 4; ++k) {
      depths[k] = view.depth(x + (k & 1), y + (k >> 1));
      if (depths[k] == kInvalidDepth || std::abs(depths[k] - nearest) > limit) return nearest;
      if (view.outlier(x + (k & 1), y + (k >> 1)) > 0.5f) return nearest;
    }
    const double u = seen.x - x, v = seen.y - y;
    return (1 - v) * ((1 - u) * depths[0] + u * depths[1]) + v * ((1 - u) * depths[2] + u * depths[3]);
  }

  const SensorModel& sensor_;
  double voxel_;
};

// The point of a field's surface that is nearest to a voxel, in a block's coordinates.
struct FootPoint {
  static constexpr int kMargin = 3;
  PaddedBlock<kMargin, kMargin> field;
  Eigen::Vector3d normal;  ///< unit, outwards
  double distance = 0;     ///< of the voxel from it, voxels, > 0 outside

  /// False where the field has no slope, or is not known.
  bool find(const Index3& v) {
    Eigen::Vector3d gradient;
    for (int a = 0; a < 3; ++a) {
      const Index3 step = Index3::Unit(a);
      gradient[a] = 0.5 * (field.at(v + step) - field.at(v - step));
    }
    const double slope = gradient.norm();
    if (!(slope > 0)) return false;
    normal = gradient / slope;
    // The field may be steeper or flatter than a distance, and bend: secants.
    const double least = kLeastSlope * slope_scale;
    double per_voxel = std::max(slope, least), value = field.at(v);
    distance = 0;
    for (int step = 0; step < kSteps; ++step) {
      const double before = distance;
      distance = std::clamp(before + value / per_voxel, -kFurthest, kFurthest);
      const double next = interpolate(v.cast<double>() - distance * normal);
      if (std::isnan(next) || distance == before) break;
      per_voxel = std::max((value - next) / (distance - before), least);
      value = next;
    }
    return true;
  }
  double slope_scale = 1;  ///< of a distance: length of a voxel

 private:
  static constexpr double kLeastSlope = 0.25, kFurthest = 2.0;
  static constexpr int kSteps = 3;

  double interpolate(const Eigen::Vector3d& p) const {
    const Index3 low = p.array().floor().cast<int>();
    const Eigen::Vector3d t = p - low.cast<double>();
    double sum = 0;
    for (int k = 0; k < 8; ++k) {
      const Index3 d(k >> 2, k >> 1 & 1, k & 1);
      const Eigen::Vector3d w =
          d.cast<double>().cwiseProduct(t) +
          (1 - d.cast<double>().array()).matrix().cwiseProduct((1 - t.array()).matrix());
      sum += w.prod() * field.at(low + d);
    }
    return sum;
  }
};

struct SeenProbe {
  std::size_t probe;
  PixelDepth place;
};

// Finds the pixels first, so that they are on their way when they are looked at.
template <class Meter>
void addView(const Meter& meter, const PreparedView& view, std::vector<Probe>& probes,
             std::vector<SeenProbe>& seen) {
  seen.clear();
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!meter.mightCount(view, probes[i])) continue;
    const std::optional<PixelDepth> place = view.projector.place(probes[i].point);
    if (!place) continue;
    const int x = nearestPixel(place->x), y = nearestPixel(place->y);
    __builtin_prefetch(&view.view->depth(x, y));
    __builtin_prefetch(&view.view->outlier(x, y));
    seen.push_back({i, *place});
  }
  for (const SeenProbe& s : seen) meter.add(view, s.place, probes[s.probe]);
}

// Asks all views about the probes of blocks [begin, end). Windows of views pass by on the outside.
template <class Meter>
void askViews(const JudgedViews& judged, const BlockField& field, const Meter& meter, std::size_t begin,
              std::vector<std::vector<Probe>>& probes) {
  constexpr double kBlockRadius = 0.5 * 8 * 1.7320508 + 2;  // points may lie beside their voxels
  forEachWindow(judged.views, [&](std::size_t first, std::size_t last) {
    std::vector<PreparedView> views;
    for (std::size_t i = first; i < last; ++i) {
      views.emplace_back(judged.views[i]);
    }
    parallelFor(probes.size(), kBlocksPerTask, [&](std::size_t low, std::size_t high) {
      std::vector<SeenProbe> seen;
      for (std::size_t b = low; b < high; ++b) {
        if (probes[b].empty()) continue;
        const Eigen::Vector3d centre = field.frame.toWorld(
            Eigen::Vector3d(field.blocks.origin(begin + b).template cast<double>().array() + 3.5));
        for (const PreparedView& view : views) {
          if (!view.projector.mightSee(centre, kBlockRadius * field.frame.voxel)) continue;
          addView(meter, view, probes[b], seen);
        }
      }
    });
  });
}

// `make(block)` gives the probes of a block.
template <class Meter, class Make>
MeasuredField measure(const JudgedViews& judged, const BlockField& field, const Meter& meter,
                      const Make& make, const char* name, const Progress& progress) {
  MeasuredField result{std::vector<float>(field.values.size(), kUnknown),
                       std::vector<float>(field.values.size(), 0.0f)};
  ProgressStep step(progress, name, field.blocks.count());
  for (std::size_t begin = 0; begin < field.blocks.count(); begin += kBlocksPerPass) {
    const std::size_t end = std::min(begin + kBlocksPerPass, field.blocks.count());
    std::vector<std::vector<Probe>> probes(end - begin);
    parallelFor(probes.size(), kBlocksPerTask, [&](std::size_t first, std::size_t last) {
      for (std::size_t b = first; b < last; ++b) probes[b] = make(begin + b);
    });
    askViews(judged, field, meter, begin, probes);
    for (std::size_t b = 0; b < probes.size(); ++b) {
      for (const Probe& probe : probes[b]) {
        if (!(probe.weight > 0)) continue;
        const std::size_t voxel = (begin + b) * kBlockSize + probe.voxel;
        result.distance[voxel] = static_cast<float>(probe.distance / probe.weight);
        result.weight[voxel] = static_cast<float>(probe.weight);
      }
    }
    step.advance(end - begin);
  }
  return result;
}

}  // namespace

MeasuredField measureDistances(const JudgedViews& judged, const BlockField& sides,
                               const std::vector<float>& wanted, const Progress& progress) {
  const auto make = [&](std::size_t b) {
    std::vector<Probe> probes;
    for (std::uint32_t i = 0; i < kBlockSize; ++i) {
      if (!(wanted[b * kBlockSize + i] > 0)) continue;
      const Index3 voxel = sides.blocks.origin(b) + leafOffset(static_cast<int>(i));
      probes.push_back({i, sides.block(b)[i], sides.frame.toWorld(voxel)});
    }
    return probes;
  };
  return measure(judged, sides, DistanceMeter(judged.sensor, sides.frame.voxel), make, "place surface",
                 progress);
}

MeasuredField measureResiduals(const JudgedViews& judged, const std::vector<float>& wanted, BlockField& field,
                               const Progress& progress) {
  const std::vector<float> before = field.values;
  const auto make = [&](std::size_t b) {
    std::vector<Probe> probes;
    FootPoint foot;
    foot.slope_scale = field.frame.voxel;
    loadPadded(field.blocks, before.data(), b, kUnknown, foot.field);
    for (std::uint32_t i = 0; i < kBlockSize; ++i) {
      if (!(wanted[b * kBlockSize + i] > 0)) continue;
      const Index3 v = leafOffset(static_cast<int>(i));
      if (!foot.find(v)) continue;
      const double distance = foot.distance * field.frame.voxel;
      field.block(b)[i] = static_cast<float>(distance);
      const Eigen::Vector3d voxel = field.frame.toWorld(Index3(field.blocks.origin(b) + v));
      probes.push_back({i, distance > 0 ? 1.0f : -1.0f, voxel - distance * foot.normal, foot.normal});
    }
    return probes;
  };
  return measure(judged, field, ResidualMeter(judged.sensor, field.frame.voxel), make, "refine surface",
                 progress);
}

}  // namespace vdbfuse
