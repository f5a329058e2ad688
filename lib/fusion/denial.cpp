// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/likelihood_ratio.h"
#include "fusion/prepared_view.h"
#include "fusion/visibility_integral.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr int kNodes = 8;
constexpr double kViewsOfEightNodes = 200;
constexpr double kPriorOfOutside = 0.75;
constexpr float kNobodyDenies = 2.0f;
// Views that repeat each other share the weight of one: taking away a view's own share alone would leave its
// copies to confirm its mistakes.
constexpr float kOwnWeight = 1.0f;
constexpr std::array kBinEnds = {-3.0f, -2.0f, -1.0f, -0.3f, 0.5f, 2.0f};

std::uint8_t denialBin(float evidence) {
  return static_cast<std::uint8_t>(std::upper_bound(kBinEnds.begin(), kBinEnds.end(), evidence) -
                                   kBinEnds.begin());
}

// Sums over all views at the points of a regular grid, from which one view's own term can be taken away.
class TestimonyGrid {
 public:
  TestimonyGrid(const JudgedViews& judged, const Box& domain)
      : low_(domain.min()),
        step_(domain.sizes().maxCoeff() / kDenialSide),
        size_((domain.sizes() / step_).array().ceil().cast<int>().max(1)),
        views_(prepare(judged)),
        ratio_(judged.sensor),
        integral_(0.5, 0.0, kViewsOfEightNodes) {}

  double step() const { return step_; }

  void fill(const Progress& progress) {
    const std::size_t count = static_cast<std::size_t>(size_.prod());
    sums_.assign(count * kNodes, 0.0f);
    reports_.assign(count, 0.0f);
    evidence_.assign(count, 0.0f);
    ProgressStep progress_step(progress, "weigh views", count);
    parallelFor(count, 2048, [&](std::size_t begin, std::size_t end) {
      for (const PreparedView& view : views_) addView(view, begin, end);
      for (std::size_t i = begin; i < end; ++i) evidence_[i] = combine(&sums_[i * kNodes], reports_[i]);
      progress_step.advance(end - begin);
    });
  }

  // Smallest evidence of the other views along the ray of a pixel, from the sensor to `end` (world).
  float smallestOnRay(std::size_t view, const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                      float outlier) const {
    const Eigen::Vector3d way = end - start;
    const double length = way.norm();
    const auto [first, last] = insideDomain(start, way);
    float smallest = kNobodyDenies;
    for (double s = first * length; s <= last * length; s += step_) {
      const std::size_t i = nearest(start + way * (s / length));
      // A view's own claim only ever raises the evidence, by no more than its own log ratio.
      if (evidence_[i] - ownBound(outlier) > smallest) continue;
      smallest = std::min(smallest, withoutOwn(i, view));
    }
    return smallest;
  }

 private:
  Eigen::Vector3d point(std::size_t i) const {
    const int nx = size_.x(), ny = size_.y(), k = static_cast<int>(i);
    return low_ + step_ * Eigen::Vector3d(k % nx + 0.5, k / nx % ny + 0.5, k / nx / ny + 0.5);
  }

  std::size_t nearest(const Eigen::Vector3d& p) const {
    const Eigen::Array3i cell = ((p - low_) / step_).array().floor().cast<int>().max(0).min(size_ - 1);
    return static_cast<std::size_t>((cell.z() * size_.y() + cell.y()) * size_.x() + cell.x());
  }

  void addView(const PreparedView& prepared, std::size_t begin, std::size_t end) {
    const JudgedView& view = *prepared.view;
    const float weight = static_cast<float>(view.weight);
    for (std::size_t i = begin; i < end; ++i) {
      const std::optional<Sighting> seen = prepared.projector(point(i));
      if (!seen) continue;
      const float measured = view.depth(seen->x, seen->y);
      if (measured == kInvalidDepth) continue;
      const float ratio = ratio_.log(measured, prepared.noise.at(measured), view.outlier(seen->x, seen->y),
                                     static_cast<float>(seen->depth));
      integral_.add(ratio, weight, &sums_[i * kNodes]);
      reports_[i] += weight;
    }
  }

  float combine(const float* sums, float reports) const {
    return static_cast<float>(std::min(kPriorOfOutside, integral_.halfDenial(reports)) +
                              integral_.logMean(sums));
  }

  static float ownBound(float outlier) { return 3.0f - std::log(outlier); }

  float withoutOwn(std::size_t i, std::size_t index) const {
    const PreparedView& prepared = views_[index];
    std::array<float, kNodes> sums;
    std::copy_n(&sums_[i * kNodes], kNodes, sums.begin());
    float reports = reports_[i];
    // What the sums hold is what the pixel at the grid point said, which may be a neighbour of the one
    // examined.
    if (const std::optional<Sighting> seen = prepared.projector(point(i))) {
      const JudgedView& view = *prepared.view;
      const float measured = view.depth(seen->x, seen->y);
      if (measured != kInvalidDepth) {
        const float ratio = ratio_.log(measured, prepared.noise.at(measured), view.outlier(seen->x, seen->y),
                                       static_cast<float>(seen->depth));
        integral_.add(ratio, -kOwnWeight, sums.data());
        reports -= kOwnWeight;
      }
    }
    return combine(sums.data(), std::max(reports, 0.0f));
  }

  // Shares of the way at which it enters and leaves the grid, within [0, 1]; first > last when it misses it.
  std::pair<double, double> insideDomain(const Eigen::Vector3d& start, const Eigen::Vector3d& way) const {
    double first = 0, last = 1;
    for (int a = 0; a < 3; ++a) {
      const double low = low_[a] - start[a], high = low + step_ * size_[a];
      if (std::abs(way[a]) < 1e-12) {
        if (low > 0 || high < 0) return {1, 0};
        continue;
      }
      first = std::max(first, std::min(low / way[a], high / way[a]));
      last = std::min(last, std::max(low / way[a], high / way[a]));
    }
    return {first, last};
  }

  Eigen::Vector3d low_;
  double step_;
  Eigen::Array3i size_;
  std::vector<PreparedView> views_;
  LikelihoodRatio ratio_;
  VisibilityIntegral integral_;
  std::vector<float> sums_, reports_, evidence_;
};

void examineRow(const TestimonyGrid& grid, const JudgedViews& judged, std::size_t index, int y,
                Image<PixelTestimony>& testimony) {
  const JudgedView& view = judged.views[index];
  for (int x = 0; x < view.depth.width(); ++x) {
    const float depth = view.depth(x, y);
    if (depth == kInvalidDepth) continue;
    const double claimed =
        depth - std::max(3 * lookupNoise(judged.sensor, view.projection, depth), 2 * grid.step());
    if (claimed <= judged.sensor.near) continue;
    const Eigen::Vector3d start =
        view.world_from_camera * unproject(view.projection, x, y, judged.sensor.near);
    const Eigen::Vector3d end = view.world_from_camera * unproject(view.projection, x, y, claimed);
    testimony(x, y).denial = denialBin(grid.smallestOnRay(index, start, end, view.outlier(x, y)));
  }
}

}  // namespace

void examineDenial(const JudgedViews& judged, const Box& domain, Testimonies& testimonies,
                   const Progress& progress) {
  TestimonyGrid grid(judged, domain);
  grid.fill(progress);
  ProgressStep step(progress, "look for denial", judged.views.size());
  for (std::size_t i = 0; i < judged.views.size(); ++i) {
    parallelFor(static_cast<std::size_t>(judged.views[i].depth.height()), 16,
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t y = begin; y < end; ++y)
                    examineRow(grid, judged, i, static_cast<int>(y), testimonies.views[i]);
                });
    step.advance();
  }
}

}  // namespace vdbfuse
