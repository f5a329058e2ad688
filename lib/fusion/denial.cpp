// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fusion/block_kernels.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr int kNodes = 8;
constexpr double kViewsOfEightNodes = 200;
constexpr double kPriorOfOutside = 0.75;
constexpr float kNobodyDenies = 2.0f;
constexpr double kClearance =
    2.0;  // grid steps between a surface and a point that its pixel claims to be free
// Views that repeat each other share the weight of one: taking away a view's own share alone would leave its
// copies to confirm its mistakes.
constexpr float kOwnWeight = 1.0f;
constexpr std::array kBinEnds = {-3.0f, -2.0f, -1.0f, -0.3f, 0.5f, 2.0f};

std::uint8_t denialBin(float evidence) {
  return static_cast<std::uint8_t>(std::upper_bound(kBinEnds.begin(), kBinEnds.end(), evidence) -
                                   kBinEnds.begin());
}

// 8³ points of the grid. Views and rays that have nothing to do with them skip them whole.
constexpr int kBrick = 8;

struct Brick {
  explicit Brick(std::vector<Eigen::Vector3d> brick_points)
      : points(std::move(brick_points)), block(points), smallest(kNobodyDenies) {}

  std::vector<Eigen::Vector3d> points;
  PointBlock block;                                ///< of `points`
  float sure = std::numeric_limits<float>::max();  ///< no less than this of any point, by all views
  float smallest;                                  ///< of the points, without the view left out
};

// Sums over all views at the points of a regular grid, from which one view's own term can be taken away.
class TestimonyGrid {
 public:
  TestimonyGrid(const JudgedViews& judged, const Box& domain)
      : low_(domain.min()),
        step_(domain.sizes().maxCoeff() / kDenialSide),
        bricks_a_side_((domain.sizes() / (step_ * kBrick)).array().ceil().cast<int>().max(1)),
        judged_(judged),
        ratio_(judged.sensor),
        integral_(0.5, 0.0, kViewsOfEightNodes) {
    const int count = bricks_a_side_.prod();
    bricks_.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) bricks_.emplace_back(pointsOf(i));
  }

  double step() const { return step_; }

  void fill(const Progress& progress) {
    const std::size_t count = bricks_.size() * PointBlock::kCapacity;
    sums_.assign(count * kNodes, 0.0f);
    reports_.assign(count, 0.0f);
    without_.assign(count, 0.0f);
    ProgressStep progress_step(progress, "weigh views", bricks_.size() * judged_.views.size());
    forEachPrepared(judged_, [&](const std::vector<PreparedView>& views) {
      forEachBrick([&](Brick& brick, std::size_t first) {
        for (const PreparedView& view : views)
          add(view, brick.block, static_cast<float>(view.view->weight), &sums_[first * kNodes],
              &reports_[first]);
        progress_step.advance(views.size());
      });
    });
    forEachBrick([&](Brick& brick, std::size_t first) {
      logMeans(integral_, &sums_[first * kNodes], PointBlock::kCapacity, &without_[first]);
      brick.sure = smallestOf(first);
    });
  }

  // From now on smallestOnRay() is about what all views but this one say, on rays of this one.
  void leaveOut(std::size_t index) {
    const PreparedView view(judged_.views[index], judged_.sensor);
    forEachBrick([&](Brick& brick, std::size_t first) {
      brick.smallest = kNobodyDenies;
      if (brick.sure - kMostOfOneView > kNobodyDenies) return;
      // A ray is nearest to points up to half a step outside the image.
      if (!view.projector.mightSee(brick.block.centre, brick.block.radius + step_)) return;
      std::array<float, PointBlock::kCapacity * kNodes> sums;
      std::array<float, PointBlock::kCapacity> reports;
      std::copy_n(&sums_[first * kNodes], sums.size(), sums.begin());
      std::copy_n(&reports_[first], reports.size(), reports.begin());
      add(view, brick.block, -kOwnWeight, sums.data(), reports.data());
      float* const evidence = &without_[first];
      logMeans(integral_, sums.data(), reports.size(), evidence);
      for (std::size_t i = 0; i < reports.size(); ++i)
        evidence[i] +=
            static_cast<float>(std::min(kPriorOfOutside, integral_.halfDenial(std::max(reports[i], 0.0f))));
      brick.smallest = smallestOf(first);
    });
  }

  // Smallest evidence along the ray of a pixel, from the sensor to `end` (world), no larger than
  // kNobodyDenies.
  float smallestOnRay(const Eigen::Vector3d& start, const Eigen::Vector3d& end) const {
    const Eigen::Vector3d way = end - start;
    const double length = way.norm();
    const auto [first, last] = insideDomain(start, way);
    const Eigen::Vector3d low = (start - low_) / step_, pace = way / length;
    float smallest = kNobodyDenies;
    double s = first * length / step_;
    while (s <= last * length / step_) {
      const Eigen::Vector3d p = low + pace * s;
      const Eigen::Array3i cell = p.array().cast<int>().max(0).min(kBrick * bricks_a_side_ - 1);
      const Eigen::Array3i brick = cell / kBrick;
      const std::size_t index = brickIndex(brick);
      if (bricks_[index].smallest >= smallest) {
        s += std::max(1.0, std::ceil(stepsToLeave(brick, p, pace)));
        continue;
      }
      smallest = std::min(smallest, without_[index * PointBlock::kCapacity + placeInBrick(cell)]);
      s += 1;
    }
    return smallest;
  }

 private:
  // log L of one view is never more: its pixel is wrong with kMinOutlier, and the point no nearer to the end
  // of the range than LikelihoodRatio::kEnd.
  static constexpr float kMostOfOneView = 12.8f;

  static std::size_t placeInBrick(const Eigen::Array3i& cell) {
    const Eigen::Array3i p = cell - cell / kBrick * kBrick;
    return static_cast<std::size_t>((p.z() * kBrick + p.y()) * kBrick + p.x());
  }

  std::size_t brickIndex(const Eigen::Array3i& brick) const {
    return static_cast<std::size_t>((brick.z() * bricks_a_side_.y() + brick.y()) * bricks_a_side_.x() +
                                    brick.x());
  }

  std::vector<Eigen::Vector3d> pointsOf(int brick) const {
    const int nx = bricks_a_side_.x(), ny = bricks_a_side_.y();
    const Eigen::Vector3d first(brick % nx, brick / nx % ny, brick / nx / ny);
    std::vector<Eigen::Vector3d> points;
    for (int z = 0; z < kBrick; ++z) {
      for (int y = 0; y < kBrick; ++y) {
        for (int x = 0; x < kBrick; ++x)
          points.emplace_back(low_ + step_ * (kBrick * first + Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5)));
      }
    }
    return points;
  }

  // In grid steps along the ray.
  static double stepsToLeave(const Eigen::Array3i& brick, const Eigen::Vector3d& p,
                             const Eigen::Vector3d& pace) {
    double steps = kBrick * 2;
    for (int a = 0; a < 3; ++a) {
      if (std::abs(pace[a]) < 1e-12) continue;
      const double wall = kBrick * (brick[a] + (pace[a] > 0 ? 1 : 0));
      steps = std::min(steps, (wall - p[a]) / pace[a]);
    }
    return steps;
  }

  float smallestOf(std::size_t first) const {
    return *std::min_element(&without_[first], &without_[first] + PointBlock::kCapacity);
  }

  // visit(brick, index of its first point), in parallel; each brick has one owner.
  template <class Visit>
  void forEachBrick(const Visit& visit) {
    parallelFor(bricks_.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(bricks_[i], i * PointBlock::kCapacity);
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
      const double low = low_[a] - start[a], high = low + step_ * kBrick * bricks_a_side_[a];
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
  Eigen::Array3i bricks_a_side_;
  const JudgedViews& judged_;
  LikelihoodRatio ratio_;
  VisibilityIntegral integral_;
  std::vector<Brick> bricks_;
  std::vector<float> sums_, reports_, without_;  ///< brick by brick
};

// A ray that comes in flat is near to the surface, and to grid points behind it, for longer.
double slant(float incidence) {
  constexpr double kFlattest = 0.2;
  return incidence > 0 ? std::max<double>(incidence, kFlattest) : 1.0;
}

void examineRow(const TestimonyGrid& grid, const JudgedViews& judged, std::size_t index, int y,
                Image<PixelTestimony>& testimony) {
  const JudgedView& view = judged.views[index];
  for (int x = 0; x < view.depth.width(); ++x) {
    const float depth = view.depth(x, y);
    if (depth == kInvalidDepth) continue;
    const double claimed = depth - std::max(3 * lookupNoise(judged.sensor, view.projection, depth),
                                            kClearance * grid.step() / slant(view.incidence(x, y)));
    if (claimed <= judged.sensor.near) continue;
    const Eigen::Vector3d start =
        view.world_from_camera * unproject(view.projection, x, y, judged.sensor.near);
    const Eigen::Vector3d end = view.world_from_camera * unproject(view.projection, x, y, claimed);
    testimony(x, y).denial = denialBin(grid.smallestOnRay(start, end)) & 7u;
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
    letGo(judged.views[i]), letGo(testimonies.views[i]);
    step.advance();
  }
}

}  // namespace vdbfuse
