// SPDX-License-Identifier: Apache-2.0
#include "formats/point_views.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <span>
#include <unordered_map>

#include "formats/stored_depth.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kMostPixels = 1 << 26;

struct Direction {
  double azimuth, elevation;
};

Direction directionOf(const Eigen::Vector3f& point) {
  const Eigen::Vector3d p = point.cast<double>();
  return {std::atan2(p.x(), p.z()), std::atan2(p.y(), std::hypot(p.x(), p.z()))};
}

template <class Visit>
void forEachPoint(const PointScan& scan, const Visit& visit) {
  for (const Eigen::Vector3f& p : scan.organised) {
    if (p.allFinite() && !p.isZero()) visit(p);
  }
  for (const Eigen::Vector3f& p : scan.loose) {
    if (p.allFinite() && !p.isZero()) visit(p);
  }
}

// Azimuths and elevations that hold points. Azimuths begin after the widest gap, so that a scan that looks
// across ±180 degrees is one piece.
struct Extent {
  double azimuth0 = 0, azimuth_width = 0;
  double elevation0 = 0, elevation_height = 0;
  double solid_angle = 0;  // of cells of a degree that hold points
  std::size_t points = 0;
};

class ExtentFinder {
 public:
  void add(const Direction& d) {
    const int column = std::clamp(static_cast<int>((d.azimuth / kDegree) + 180), 0, 359);
    const int row = std::clamp(static_cast<int>((d.elevation / kDegree) + 90), 0, 179);
    cells_[static_cast<std::size_t>(360 * row + column)] = true;
    columns_[static_cast<std::size_t>(column)] = true;
    low_ = std::min(low_, d.elevation), high_ = std::max(high_, d.elevation);
    ++points_;
  }

  Extent extent() const {
    Extent result;
    const auto [first, length] = occupiedColumns();
    result.azimuth0 = (first - 180) * kDegree;
    result.azimuth_width = length * kDegree;
    result.elevation0 = low_;
    result.elevation_height = high_ - low_;
    for (int row = 0; row < 180; ++row) {
      const double area = kDegree * kDegree * std::cos((row - 89.5) * kDegree);
      for (int column = 0; column < 360; ++column)
        result.solid_angle += cells_[static_cast<std::size_t>(360 * row + column)] ? area : 0;
    }
    result.points = points_;
    return result;
  }

 private:
  // First column after the widest gap, and number of columns up to it.
  std::pair<int, int> occupiedColumns() const {
    int first = 0, widest = 0, gap = 0;
    for (int c = 0; c < 720; ++c) {
      gap = columns_[static_cast<std::size_t>(c % 360)] ? 0 : gap + 1;
      if (gap > widest && gap <= 360) widest = gap, first = (c + 1) % 360;
    }
    return {first, 360 - widest};
  }

  std::vector<bool> cells_ = std::vector<bool>(360 * 180), columns_ = std::vector<bool>(360);
  double low_ = 2, high_ = -2;
  std::size_t points_ = 0;
};

template <class Fit>
std::optional<Projection> attempt(const PointImage& points, const Fit& fit) {
  try {
    return fit(points);
  } catch (const InvalidArgument&) {
    return std::nullopt;
  }
}

// Sum of squared distances between where points are seen and their pixels; infinite when one is not seen.
double squaredError(const PointImage& points, const Projection& projection) {
  double sum = 0;
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      const Eigen::Vector3f& p = points(x, y);
      if (!p.allFinite() || p.isZero()) continue;
      const auto seen = project(projection, p.cast<double>());
      if (!seen) return std::numeric_limits<double>::infinity();
      sum += (seen->x - x) * (seen->x - x) + (seen->y - y) * (seen->y - y);
    }
  }
  return sum;
}

// A narrow scan is nearly that of a pinhole: the better of the two.
std::optional<Projection> fitted(const PointImage& points) {
  if (points.empty()) return std::nullopt;
  const std::optional<Projection> pinhole = attempt(points, fitPinhole);
  const std::optional<Projection> scanner = attempt(points, fitSpherical);
  if (!pinhole || !scanner) return pinhole ? pinhole : scanner;
  return squaredError(points, *scanner) < squaredError(points, *pinhole) ? scanner : pinhole;
}

// As many pixels as points, over what holds points; coarser where a stray point far from the others would
// make that an image of emptiness.
double naturalStep(const Extent& extent) {
  constexpr double kMostPixelsPerPoint = 64, kSmallImage = 1 << 16;
  const auto points = static_cast<double>(extent.points);
  const double step = std::sqrt(extent.solid_angle / points);
  const double coarse = std::sqrt(extent.azimuth_width * extent.elevation_height /
                                  (kMostPixelsPerPoint * points + kSmallImage));
  return std::clamp(std::max(step, coarse), 1e-5, 5 * kDegree);
}

Spherical splatProjection(const Extent& extent, double step) {
  const double width =
                   std::min(std::round(2 * std::numbers::pi / step), std::ceil(extent.azimuth_width / step)),
               height = std::ceil(extent.elevation_height / step) + 1;
  if (!(width * height <= kMostPixels))
    throw InvalidArgument("splat_step", numberText(step) + " gives an image of more than 2^26 pixels");
  Spherical scanner;
  scanner.width = std::max(1, static_cast<int>(width)), scanner.height = static_cast<int>(height);
  // A full turn must close: the step is the whole of it divided by whole pixels.
  const bool is_full_turn = extent.azimuth_width > 359.5 * kDegree;
  scanner.azimuth_step = is_full_turn ? 2 * std::numbers::pi / scanner.width : step;
  scanner.azimuth0 = extent.azimuth0 + 0.5 * scanner.azimuth_step;
  scanner.elevation_step = step;
  scanner.elevation0 = extent.elevation0;
  return scanner;
}

Image<float> splat(const PointScan& scan, const Projection& projection) {
  Image<float> depth(imageWidth(projection), imageHeight(projection), kInvalidDepth);
  forEachPoint(scan, [&](const Eigen::Vector3f& p) {
    const auto seen = project(projection, p.cast<double>());
    if (!seen) return;
    const int x = nearestPixel(seen->x), y = nearestPixel(seen->y);
    if (!depth.contains(x, y)) return;
    const auto range = static_cast<float>(seen->depth);
    float& nearest = depth(x, y);
    if (nearest == kInvalidDepth || range < nearest) nearest = range;
  });
  return depth;
}

struct Scans {
  ScanSource source;
  std::vector<ScanProjection> projections;
  ReadOptions options;
};

DepthMap loadScan(const Scans& scans, std::size_t index) {
  DepthMap map;
  map.depth = depthOf(scans.source.load(index), scans.projections[index]);
  limitPointDepth(map.depth, scans.options);
  return map;
}

Extent extentOf(std::span<const PointScan> scans) {
  ExtentFinder finder;
  for (const PointScan& scan : scans)
    forEachPoint(scan, [&](const Eigen::Vector3f& p) { finder.add(directionOf(p)); });
  const Extent extent = finder.extent();
  if (extent.points == 0) throw InvalidArgument("scan", "expected points, found none that is finite");
  return extent;
}

// An image that holds all scans, as fine as the finest of them.
ScanProjection splatOf(std::span<const PointScan> scans, std::optional<double> splat_step) {
  double step = 1;
  for (const PointScan& scan : scans) step = std::min(step, naturalStep(extentOf({&scan, 1})));
  return {splatProjection(extentOf(scans), splat_step.value_or(step)), ScanProjection::Origin::Splat};
}

std::vector<ScanProjection> projectionsOf(const std::filesystem::path& input, const ScanSource& source,
                                          const ReadOptions& options) {
  constexpr std::size_t kEnough = 8;
  const std::size_t count = source.headers.size();
  std::vector<ScanProjection> result;
  try {
    if (source.sensors == ScanSource::Sensors::OneForAll && count > kEnough) {
      std::vector<PointScan> some;
      for (std::size_t k = 0; k < kEnough; ++k) some.push_back(source.load(k * count / kEnough));
      result.assign(count, projectionOfAll(some, options.splat_step));
    }
    while (result.size() < count)
      result.push_back(projectionOf(source.load(result.size()), options.splat_step));
  } catch (const InvalidArgument& error) {
    throw IoError(input, "scan " + source.headers[result.size() % count].name, "points that make a depth map",
                  error.what());
  }
  return result;
}

std::string splatNote(const std::vector<ScanProjection>& projections) {
  std::size_t count = 0;
  double finest = 0, coarsest = 0;
  for (const ScanProjection& p : projections) {
    if (p.origin != ScanProjection::Origin::Splat) continue;
    const double step = std::get<Spherical>(p.projection).elevation_step / kDegree;
    finest = count == 0 ? step : std::min(finest, step), coarsest = std::max(coarsest, step);
    ++count;
  }
  if (count == 0) return {};
  std::string text =
      counted(count, "scan") + " made into spherical depth maps, a pixel every " + numberText(finest);
  if (coarsest > finest) text += " to " + numberText(coarsest);
  return text + " degrees (--splat-step)";
}

}  // namespace

RigidTransform cameraFromScanner() {
  RigidTransform result = RigidTransform::Identity();
  result.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return result;
}

ScanProjection projectionOf(const PointScan& scan, std::optional<double> splat_step) {
  if (const auto projection = fitted(scan.organised)) return {*projection, ScanProjection::Origin::Fitted};
  return splatOf({&scan, 1}, splat_step);
}

ScanProjection projectionOfAll(const std::vector<PointScan>& scans, std::optional<double> splat_step) {
  return splatOf(scans, splat_step);
}

Image<float> depthOf(const PointScan& scan, const ScanProjection& found) {
  if (found.origin == ScanProjection::Origin::Splat) return splat(scan, found.projection);
  return viewFromPoints(scan.organised, found.projection, RigidTransform::Identity()).map.depth;
}

DepthSet setOfScans(const std::filesystem::path& input, ScanSource source, const ReadOptions& options,
                    const std::string& format) {
  requirePointOptions(options, DepthKind::Range, format);
  if (source.headers.empty()) throw IoError(input, "", "a scan", "none");
  auto scans = std::make_shared<Scans>(Scans{std::move(source), {}, options});
  std::vector<ViewHeader> headers = scans->source.headers;
  scans->projections = projectionsOf(input, scans->source, options);
  for (std::size_t i = 0; i < headers.size(); ++i) headers[i].projection = scans->projections[i].projection;
  DepthSet set;
  set.reading = {scans->source.stored, std::nullopt, options.depth_scale.value_or(1.0), scans->source.invalid,
                 scans->source.pose};
  set.stored_from_camera = scans->source.stored_from_camera;
  if (const std::string note = splatNote(scans->projections); !note.empty()) set.notes.push_back(note);
  set.views =
      ViewSequence(std::move(headers), [scans](std::size_t index) { return loadScan(*scans, index); });
  return set;
}

}  // namespace vdbfuse
