// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/block_kernels.h"
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
    without_.assign(count, 0.0f);
    ProgressStep progress_step(progress, "weigh views", count);
    forEachBlock([&](std::size_t first, const PointBlock& block) {
      for (const PreparedView& view : views_)
        add(view, block, static_cast<float>(view.view->weight), &sums_[first * kNodes], &reports_[first]);
      progress_step.advance(block.size);
    });
  }

  // From now on smallestOnRay() is about what all views but this one say.
  void leaveOut(std::size_t view) {
    forEachBlock([&](std::size_t first, const PointBlock& block) {
      std::vector<float> sums(&sums_[first * kNodes], &sums_[first * kNodes] + block.size * kNodes);
      std::vector<float> reports(&reports_[first], &reports_[first] + block.size);
      add(views_[view], block, -kOwnWeight, sums.data(), reports.data());
      float* const evidence = &without_[first];
      logMeans(integral_, sums.data(), block.size, evidence);
      for (std::size_t i = 0; i < block.size; ++i)
        evidence[i] +=
            static_cast<float>(std::min(kPriorOfOutside, integral_.halfDenial(std::max(reports[i], 0.0f))));
    });
  }

  // Smallest evidence along the ray of a pixel, from the sensor to `end` (world).
  float smallestOnRay(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const {
    const Eigen::Vector3d way = end - start;
    const double length = way.norm();
    const auto [first, last] = insideDomain(start, way);
    float smallest = kNobodyDenies;
    for (double s = first * length; s <= last * length; s += step_)
      smallest = std::min(smallest, without_[nearest(start + way * (s / length))]);
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

  // visit(index of its first point, block), in parallel; each block has one owner.
  template <class Visit>
  void forEachBlock(const Visit& visit) const {
    parallelFor(static_cast<std::size_t>(size_.prod()), PointBlock::kCapacity,
                [&](std::size_t begin, std::size_t end) {
                  std::vector<Eigen::Vector3d> points;
                  for (std::size_t i = begin; i < end; ++i) points.push_back(point(i));
                  visit(begin, PointBlock(points));
                });
  }

  // What the sums hold is what the pixel at the grid point said, which may be a neighbour of the one
  // examined.
  void add(const PreparedView& view, const PointBlock& block, float weight, float* sums,
           float* reports) const {
    if (!view.projector.mightSee(block.centre, block.radius)) return;
    const BlockTestimony said = testify(view, ratio_, 0.0f, look(view, block), block.size);
    accumulate(integral_, said, weight, block.size, sums);
    for (std::size_t i = 0; i < block.size; ++i) reports[i] += weight * said.share[i];
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
  std::vector<float> sums_, reports_, without_;
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
    testimony(x, y).denial = denialBin(grid.smallestOnRay(start, end));
  }
}

}  // namespace

void examineDenial(const JudgedViews& judged, const Box& domain, Testimonies& testimonies,
                   const Progress& progress) {
  TestimonyGrid grid(judged, domain);
  grid.fill(progress);
  ProgressStep step(progress, "look for denial", judged.views.size());
  for (std::size_t i = 0; i < judged.views.size(); ++i) {
    grid.leaveOut(i);
    parallelFor(static_cast<std::size_t>(judged.views[i].depth.height()), 16,
                [&](std::size_t begin, std::size_t end) {
                  for (std::size_t y = begin; y < end; ++y)
                    examineRow(grid, judged, i, static_cast<int>(y), testimonies.views[i]);
                });
    step.advance();
  }
}

}  // namespace vdbfuse
