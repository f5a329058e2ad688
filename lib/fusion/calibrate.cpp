// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/calibrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "fusion/half_normal.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/fusion/pixel_surface.h"
#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

// Pixels of a view that are looked at, for any size of image: enough for a histogram, and seconds for 1000
// views.
constexpr double kPixelsPerView = 3000;
constexpr std::size_t kNearPairs = 6, kFarPairs = 6;
constexpr std::array kAngleBinsDeg = {2.0, 8.0, 20.0, 40.0, 60.0, 75.0};
constexpr std::size_t kEnoughPairs = 400;
// More are not fitted: half a million tell a scale to 0.1 %.
constexpr std::size_t kEnoughResiduals = 500'000;
// Residuals beyond this share of the depth are not noise; what lies below is modelled.
constexpr double kLargestResidual = 0.03;
// A surface that either view sees at a flatter angle, or from behind, says little of the noise along the
// rays.
constexpr double kLeastCosine = 0.3;

struct Residual {
  double distance;  // along the normal
  std::array<double, 2> cosines, depths;
  std::size_t angle_bin;

  // Standard deviation of `distance` where the noise along a ray is (depth/typical)^exponent.
  double spread(int exponent, double typical) const {
    return std::hypot(cosines[0] * std::pow(depths[0] / typical, exponent),
                      cosines[1] * std::pow(depths[1] / typical, exponent));
  }
};

int sampleStride(const Image<float>& depth) {
  return std::max(1, static_cast<int>(std::sqrt(static_cast<double>(depth.size()) / kPixelsPerView)));
}

template <class Visit>
void visitSample(const Image<float>& depth, const Visit& visit) {
  const int stride = sampleStride(depth);
  for (int y = stride / 2; y < depth.height(); y += stride) {
    for (int x = stride / 2; x < depth.width(); x += stride) {
      if (depth(x, y) != kInvalidDepth) visit(x, y);
    }
  }
}

double quantile(std::vector<double>& values, double share) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::vector<std::size_t> pairedViews(const ViewGraph& graph, std::size_t view) {
  const std::vector<std::size_t>& order = graph.byAngle(view);
  std::vector<std::size_t> chosen(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(kNearPairs, order.size())));
  constexpr double kFarthest = 75.0 * std::numbers::pi / 180;
  std::size_t reach = chosen.size();
  while (reach < order.size() && graph.angle(view, order[reach]) < kFarthest) ++reach;
  const std::size_t spare = reach - chosen.size();
  const std::size_t far = std::min(kFarPairs, spare);
  for (std::size_t k = 0; k < far; ++k)
    chosen.push_back(order[kNearPairs + (k * spare) / far + spare / (2 * far)]);
  return chosen;
}

class ResidualCollector {
 public:
  ResidualCollector(const std::vector<View>& views, const NoiseLaw& guess) : views_(views), guess_(guess) {}

  std::vector<Residual> collect(std::size_t index, const std::vector<std::size_t>& pairs) const {
    const View& view = views_[index];
    std::vector<Sample> samples;
    visitSample(view.map.depth, [&](int x, int y) {
      const Eigen::Vector3f normal = surfaceNormal(view, guess_, x, y);
      if (!normal.isZero()) samples.push_back({x, y, normal.cast<double>()});
    });
    std::vector<Residual> result;
    for (const std::size_t other : pairs) {
      const Projector projector(views_[other].projection, views_[other].world_from_camera);
      for (const Sample& s : samples) compare(view, s.x, s.y, s.normal, views_[other], projector, result);
    }
    return result;
  }

 private:
  static void compare(const View& view, int x, int y, const Eigen::Vector3d& normal, const View& other,
                      const Projector& projector, std::vector<Residual>& out) {
    const Eigen::Vector3d point = worldPoint(view, x, y);
    const std::optional<Sighting> seen = projector(point);
    if (!seen || other.map.depth(seen->x, seen->y) == kInvalidDepth) return;
    // The other view's point lies on its own measured surface, so that a slant costs nothing in a planar
    // place.
    const double residual = std::abs(normal.dot(worldPoint(other, seen->x, seen->y) - point));
    const double depth = view.map.depth(x, y);
    if (residual > kLargestResidual * depth) return;
    const Eigen::Vector3d ray = (point - view.world_from_camera.translation()).normalized();
    const Eigen::Vector3d other_ray = (point - other.world_from_camera.translation()).normalized();
    const double angle = std::acos(std::clamp(ray.dot(other_ray), -1.0, 1.0)) * 180 / std::numbers::pi;
    const auto bin = std::upper_bound(kAngleBinsDeg.begin(), kAngleBinsDeg.end(), angle);
    if (bin == kAngleBinsDeg.end()) return;
    const double cosine = -normal.dot(ray), other_cosine = -normal.dot(other_ray);
    if (std::min(cosine, other_cosine) < kLeastCosine) return;
    out.push_back({residual,
                   {cosine, other_cosine},
                   {depth, other.map.depth(seen->x, seen->y)},
                   static_cast<std::size_t>(bin - kAngleBinsDeg.begin())});
  }

  struct Sample {
    int x, y;
    Eigen::Vector3d normal;
  };

  const std::vector<View>& views_;
  const NoiseLaw& guess_;
};

// At most `count` of them, evenly.
std::vector<Residual> thinned(const std::vector<Residual>& residuals, std::size_t count) {
  std::vector<Residual> result;
  const std::size_t kept = std::min(count, residuals.size());
  for (std::size_t i = 0; i < kept; ++i) result.push_back(residuals[i * residuals.size() / kept]);
  return result;
}

std::vector<Residual> collectResiduals(const std::vector<View>& views, const ViewGraph& graph,
                                       const NoiseLaw& guess, const Progress& progress) {
  std::vector<std::vector<Residual>> parts(views.size());
  ProgressStep step(progress, "calibrate noise", views.size());
  const ResidualCollector collector(views, guess);
  Neighbourhoods pairs{pathThrough(graph, views.size()),
                       {},
                       windowBytes(views.front().memory()),
                       [&](std::size_t i) { return imageBytes(views[i]); },
                       [&](std::size_t i) { letGo(views[i]); }};
  for (std::size_t i = 0; i < views.size(); ++i) pairs.needed.push_back(pairedViews(graph, i));
  forEachNeighbourhood(pairs, [&](std::size_t i) {
    parts[i] = thinned(collector.collect(i, pairs.needed[i]), kEnoughResiduals / views.size() + 1);
    step.advance();
  });
  std::vector<Residual> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// Residuals of one bin (or of all) divided by what noise of scale 1 at the typical depth makes of them.
std::vector<double> normalised(const std::vector<Residual>& residuals, int exponent, double typical,
                               std::optional<std::size_t> bin) {
  std::vector<double> result;
  for (const Residual& r : residuals) {
    if (bin && r.angle_bin != *bin) continue;
    result.push_back(r.distance / r.spread(exponent, typical));
  }
  return result;
}

double logJacobian(const std::vector<Residual>& residuals, int exponent, double typical) {
  double sum = 0;
  for (const Residual& r : residuals) sum -= std::log(r.spread(exponent, typical));
  return sum;
}

int likeliestExponent(const std::vector<Residual>& residuals, double typical) {
  int best = 0;
  double best_likelihood = -std::numeric_limits<double>::infinity();
  for (const int exponent : {0, 1, 2}) {
    const HalfNormalFit fit = fitHalfNormal(normalised(residuals, exponent, typical, std::nullopt));
    const double likelihood = fit.log_likelihood + logJacobian(residuals, exponent, typical);
    if (likelihood > best_likelihood) best = exponent, best_likelihood = likelihood;
  }
  return best;
}

double largestBinScale(const std::vector<Residual>& residuals, int exponent, double typical) {
  double largest = 0;
  for (std::size_t bin = 0; bin < kAngleBinsDeg.size(); ++bin) {
    const std::vector<double> values = normalised(residuals, exponent, typical, bin);
    if (values.size() < kEnoughPairs) continue;
    largest = std::max(largest, fitHalfNormal(values).scale);
  }
  return largest;
}

NoiseLaw powerLaw(double scale, int exponent, double typical) {
  NoiseLaw law;
  (exponent == 0   ? law.constant
   : exponent == 1 ? law.linear
                   : law.quadratic) = scale / std::pow(typical, exponent);
  return law;
}

}  // namespace

DepthStatistics depthStatistics(const std::vector<View>& views, const std::optional<Box>& domain) {
  std::vector<double> depths, inside;
  forEachView(views, [&](const View& view) {
    visitSample(view.map.depth, [&](int x, int y) {
      depths.push_back(view.map.depth(x, y));
      if (domain && domain->contains(worldPoint(view, x, y))) inside.push_back(depths.back());
    });
  });
  if (depths.empty()) throw InvalidArgument("views", "no view has a valid depth");
  const double median = quantile(inside.empty() ? depths : inside, 0.5);
  return {0.97 * quantile(depths, 0.002), median, 1.03 * quantile(depths, 0.998)};
}

NoiseLaw guessNoise(const std::vector<View>& views, double typical_depth) {
  std::vector<double> ratios;
  forEachView(views, [&](const View& view) {
    const Image<float>& depth = view.map.depth;
    visitSample(depth, [&](int x, int y) {
      if (x == 0 || x + 1 == depth.width()) return;
      const double left = depth(x - 1, y), here = depth(x, y), right = depth(x + 1, y);
      if (left == kInvalidDepth || right == kInvalidDepth) return;
      ratios.push_back(std::abs(left - 2 * here + right) / footprint(view.projection, here));
    });
  });
  // Standard deviation from the median of |second difference|; never below a tenth of a pixel's footprint.
  const double ratio = ratios.empty() ? 0.5 : quantile(ratios, 0.5) / (0.6745 * std::sqrt(6.0));
  return powerLaw(std::max(ratio, 0.1) * footprint(views.front().projection, typical_depth), 1,
                  typical_depth);
}

NoiseCalibration calibrateNoise(const std::vector<View>& views, const ViewGraph& graph, const NoiseLaw& guess,
                                double typical_depth, const Progress& progress) {
  const std::vector<Residual> residuals = collectResiduals(views, graph, guess, progress);
  NoiseCalibration result{guess, 1, guess.at(typical_depth), residuals.size()};
  if (residuals.size() < kEnoughPairs) return result;
  result.exponent = likeliestExponent(residuals, typical_depth);
  const double scale = largestBinScale(residuals, result.exponent, typical_depth);
  if (!(scale > 0)) return result;
  result.scale_at_median = scale;
  result.noise = powerLaw(scale, result.exponent, typical_depth);
  return result;
}

}  // namespace vdbfuse
