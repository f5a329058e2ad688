// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "fusion/block_kernels.h"
#include "fusion/denial_kernels.h"
#include "fusion/depth_tiles.h"
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

// 8³ points of the grid. Views that have nothing to do with them skip them whole, rays half a side at a time.
constexpr int kBrick = BrickedEvidence::kBrick, kHalf = BrickedEvidence::kHalf;
constexpr std::size_t kOctants = BrickedEvidence::kOctants, kOctant = BrickedEvidence::kOctant;

struct Brick {
  explicit Brick(std::vector<Eigen::Vector3d> brick_points)
      : points(std::move(brick_points)), block(points) {}

  std::vector<Eigen::Vector3d> points;
  PointBlock block;                                ///< of `points`
  float sure = std::numeric_limits<float>::max();  ///< no less than this of any point, by all views
};

// The pixels that may see a box, and the depth of its nearest corner.
struct BoxSight {
  float left, top, right, bottom, nearest;
};

// Boxes as an undistorted pinhole sees them; nothing is known of other projections.
class BoxCamera {
 public:
  // `origin`: what boxes are relative to.
  BoxCamera(const Projector& projector, const Eigen::Vector3d& origin) : rows_(projector.rowsFrom(origin)) {}

  // Nothing where the box reaches behind the sensor.
  std::optional<BoxSight> operator()(const Eigen::Vector3f& low, float side) const {
    if (!rows_) return std::nullopt;
    constexpr float kFar = std::numeric_limits<float>::max();
    constexpr float kSlack = 1;  // pixels
    BoxSight sight{kFar, kFar, -kFar, -kFar, kFar};
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3f place =
          low + side * Eigen::Array3i(corner & 1, corner >> 1 & 1, corner >> 2).cast<float>().matrix();
      const float depth = row(2, place);
      if (!(depth > 0)) return std::nullopt;
      const float u = row(0, place) / depth, v = row(1, place) / depth;
      sight.left = std::min(sight.left, u - kSlack), sight.right = std::max(sight.right, u + kSlack);
      sight.top = std::min(sight.top, v - kSlack), sight.bottom = std::max(sight.bottom, v + kSlack);
      sight.nearest = std::min(sight.nearest, depth);
    }
    return sight;
  }

 private:
  float row(std::size_t r, const Eigen::Vector3f& p) const {
    const auto& m = rows_->rows[r];
    return m[0] * p.x() + m[1] * p.y() + m[2] * p.z() + m[3];
  }

  std::optional<PinholeRows> rows_;
};

// The depth from which on the rays of each tile of an image may be denied.
class DenialTiles {
 public:
  DenialTiles(int width, int height)
      : first_((width + kSide - 1) / kSide, (height + kSide - 1) / kSide, std::numeric_limits<float>::max()) {
  }

  void markAll() { std::fill(first_.begin(), first_.end(), 0.0f); }

  void mark(const BoxSight& box) {
    const auto tile = [](float pixel, int count) {
      return static_cast<int>(std::clamp(std::floor(pixel / kSide), -1.0f, static_cast<float>(count)));
    };
    const int left = std::max(tile(box.left, first_.width()), 0),
              right = std::min(tile(box.right, first_.width()), first_.width() - 1);
    const int top = std::max(tile(box.top, first_.height()), 0),
              bottom = std::min(tile(box.bottom, first_.height()), first_.height() - 1);
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) first_(x, y) = std::min(first_(x, y), box.nearest);
    }
  }

  float at(int x, int y) const { return first_(x / kSide, y / kSide); }

 private:
  static constexpr int kSide = DepthTiles::kSide;
  Image<float> first_;
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
    with_all_.assign(count, 0.0f);
    without_.assign(count, 0.0f);
    smallest_.assign(bricks_.size() * kOctants, kNobodyDenies);
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
      logMeans(integral_, &sums_[first * kNodes], PointBlock::kCapacity, &with_all_[first]);
      brick.sure = *std::min_element(&with_all_[first], &with_all_[first] + PointBlock::kCapacity);
    });
  }

  // From now on findSmallest() is about what all views but this one say, on rays of this one. Says where it
  // need not be asked.
  DenialTiles leaveOut(const PreparedView& view) {
    const BoxCamera camera(view.projector, low_);
    const DepthTiles depths(view.view->depth);
    forEachBrick([&](Brick& brick, std::size_t first) {
      float* const smallest = &smallest_[first / kOctant];
      std::fill_n(smallest, kOctants, kNobodyDenies);
      if (brick.sure - kMostOfOneView > kNobodyDenies) return;
      // A ray is nearest to points up to half a step outside the image.
      if (!view.projector.mightSee(brick.block.centre, brick.block.radius + step_)) return;
      const auto sight = camera(lowCorner(first), static_cast<float>(kBrick * step_));
      // Nor do its rays go so far.
      if (sight && sight->nearest > depths.over(sight->left, sight->top, sight->right, sight->bottom).most)
        return;
      leaveOut(view, brick, first);
      smallestOfOctants(&without_[first], smallest);
    });
    DenialTiles tiles(view.view->depth.width(), view.view->depth.height());
    for (std::size_t i = 0; i < smallest_.size(); ++i) {
      if (smallest_[i] >= kNobodyDenies) continue;
      const auto octant = camera(lowCorner(i * kOctant), static_cast<float>(kHalf * step_));
      if (!octant) {
        tiles.markAll();
        break;
      }
      tiles.mark(*octant);
    }
    return tiles;
  }

  // Adds the ray of a pixel of the view left out, from `start` to `end` (world). `safe`: share of it that
  // nobody denies.
  void addRay(const Eigen::Vector3d& start, const Eigen::Vector3d& end, double safe, RayBatch& rays) const {
    const Eigen::Vector3f from = ((start - low_) / step_).cast<float>(),
                          way = ((end - start) / step_).cast<float>();
    for (std::size_t a = 0; a < 3; ++a) {
      rays.start[a][rays.size] = from[static_cast<Eigen::Index>(a)];
      rays.way[a][rays.size] = way[static_cast<Eigen::Index>(a)];
    }
    rays.safe[rays.size++] = static_cast<float>(safe);
  }

  // Smallest evidence along rays, no larger than kNobodyDenies.
  void findSmallest(RayBatch& rays) const {
    const Eigen::Array3i points = kBrick * bricks_a_side_;
    vdbfuse::findSmallest({without_.data(), smallest_.data(), {points.x(), points.y(), points.z()}},
                          kNobodyDenies, rays);
  }

 private:
  // log L of one view is never more: its pixel is wrong with kMinOutlier, and the point no nearer to the end
  // of the range than LikelihoodRatio::kEnd.
  static constexpr float kMostOfOneView = 12.8f;

  static std::size_t octant(int x, int y, int z) {
    return static_cast<std::size_t>(z / kHalf * 4 + y / kHalf * 2 + x / kHalf);
  }

  // Of a brick or an octant, by its first point; relative to the grid's.
  Eigen::Vector3f lowCorner(std::size_t first) const {
    const auto brick = static_cast<int>(first / PointBlock::kCapacity),
               octant = static_cast<int>(first % PointBlock::kCapacity / kOctant);
    const int nx = bricks_a_side_.x(), ny = bricks_a_side_.y();
    const Eigen::Array3i corner = kBrick * Eigen::Array3i(brick % nx, brick / nx % ny, brick / nx / ny) +
                                  kHalf * Eigen::Array3i(octant & 1, octant >> 1 & 1, octant >> 2);
    return (corner.cast<double>() * step_).cast<float>().matrix();
  }

  // Of the octants of a brick.
  static void smallestOfOctants(const float* evidence, float* smallest) {
    for (int z = 0; z < kBrick; ++z) {
      for (int y = 0; y < kBrick; ++y) {
        for (int x = 0; x < kBrick; ++x, ++evidence) {
          float& least = smallest[octant(x, y, z)];
          least = std::min(least, *evidence);
        }
      }
    }
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

  // visit(brick, index of its first point), in parallel; each brick has one owner.
  template <class Visit>
  void forEachBrick(const Visit& visit) {
    parallelFor(bricks_.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(bricks_[i], i * PointBlock::kCapacity);
    });
  }

  // Finds `without_` of a brick, no larger than kNobodyDenies. Without a view that says log L the evidence is
  // no less than with it by more than that, so that most points need not be looked at.
  void leaveOut(const PreparedView& view, const Brick& brick, std::size_t first) {
    const BlockTestimony said = testify(view, ratio_, 0.0f, look(view, brick.block), brick.block.size);
    BlockTestimony taken;
    std::array<float, PointBlock::kCapacity * kNodes> sums;
    std::array<std::size_t, PointBlock::kCapacity> points;
    std::size_t count = 0;
    for (std::size_t i = 0; i < brick.block.size; ++i) {
      without_[first + i] = kNobodyDenies;
      if (with_all_[first + i] - std::max(said.log_ratio[i], 0.0f) > kNobodyDenies) continue;
      std::copy_n(&sums_[(first + i) * kNodes], kNodes, &sums[count * kNodes]);
      taken.log_ratio[count] = said.log_ratio[i], taken.share[count] = said.share[i];
      points[count++] = first + i;
    }
    accumulate(integral_, taken, -kOwnWeight, count, sums.data());
    std::array<float, PointBlock::kCapacity> evidence;
    logMeans(integral_, sums.data(), count, evidence.data());
    for (std::size_t i = 0; i < count; ++i) {
      const float reports = std::max(reports_[points[i]] - kOwnWeight * taken.share[i], 0.0f);
      const double denial = std::min(kPriorOfOutside, integral_.halfDenial(reports));
      without_[points[i]] = std::min(evidence[i] + static_cast<float>(denial), kNobodyDenies);
    }
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

  Eigen::Vector3d low_;
  double step_;
  Eigen::Array3i bricks_a_side_;
  const JudgedViews& judged_;
  LikelihoodRatio ratio_;
  VisibilityIntegral integral_;
  std::vector<Brick> bricks_;
  std::vector<float> sums_, reports_;      ///< brick by brick
  std::vector<float> with_all_, without_;  ///< evidence of all views, and without the one left out
  std::vector<float> smallest_;            ///< of `without_` in each octant of each brick
};

// A ray that comes in flat is near to the surface, and to grid points behind it, for longer.
double slant(float incidence) {
  constexpr double kFlattest = 0.2;
  return incidence > 0 ? std::max<double>(incidence, kFlattest) : 1.0;
}

// Looks at the rays of one view.
class RayExaminer {
 public:
  RayExaminer(const TestimonyGrid& grid, const DenialTiles& tiles, const PreparedView& view, double near)
      : grid_(grid),
        tiles_(tiles),
        view_(view),
        unprojector_(view.view->projection, view.view->world_from_camera),
        near_(near) {}

  void examineRow(int y, PixelTestimony* testimony) const {
    RayBatch rays;
    std::array<int, RayBatch::kCapacity> pixels;
    const auto look = [&] {
      grid_.findSmallest(rays);
      for (std::size_t i = 0; i < rays.size; ++i)
        testimony[pixels[i]].denial = denialBin(rays.smallest[i]) & 7u;
      rays.size = 0;
    };
    for (int x = 0; x < view_.view->depth.width(); ++x) {
      if (view_.view->depth(x, y) == kInvalidDepth) continue;
      const double claimed = claimedDepth(x, y), denied_from = tiles_.at(x, y);
      if (claimed <= std::max(near_, denied_from)) continue;
      pixels[rays.size] = x;
      grid_.addRay(unprojector_(x, y, near_), unprojector_(x, y, claimed),
                   std::max(denied_from - near_, 0.0) / (claimed - near_), rays);
      if (rays.size == RayBatch::kCapacity) look();
    }
    if (rays.size > 0) look();
  }

 private:
  // Up to there a pixel says that space is free.
  double claimedDepth(int x, int y) const {
    const float depth = view_.view->depth(x, y);
    return depth - std::max<double>(3 * view_.noise.at(depth),
                                    kClearance * grid_.step() / slant(view_.view->incidence(x, y)));
  }

  const TestimonyGrid& grid_;
  const DenialTiles& tiles_;
  const PreparedView& view_;
  Unprojector unprojector_;
  double near_;
};

}  // namespace

void examineDenial(const JudgedViews& judged, const Box& domain, Testimonies& testimonies,
                   const Progress& progress) {
  TestimonyGrid grid(judged, domain);
  grid.fill(progress);
  ProgressStep step(progress, "look for denial", judged.views.size());
  for (std::size_t i = 0; i < judged.views.size(); ++i) {
    const PreparedView view(judged.views[i], judged.sensor);
    const DenialTiles tiles = grid.leaveOut(view);
    const RayExaminer examiner(grid, tiles, view, judged.sensor.near);
    parallelFor(static_cast<std::size_t>(judged.views[i].depth.height()), 16,
                [&](std::size_t begin, std::size_t end) {
                  for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                    examiner.examineRow(y, testimonies.views[i].row(y));
                });
    letGo(judged.views[i]), letGo(testimonies.views[i]);
    step.advance();
  }
}

}  // namespace vdbfuse
