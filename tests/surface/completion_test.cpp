// SPDX-License-Identifier: Apache-2.0
#include "surface/completion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "octree/random_octree.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;
using Distance = std::function<double(const Vector3d&)>;
using Predicate = std::function<bool(const Vector3d&)>;

// A surface that is measured in part, in a cube of voxels around the origin; nobody says anything of the
// rest.
class Instance {
 public:
  /// `distance` is that of the surface, > 0 outside; `label` says where the cut put the inside.
  Instance(int half_side, const Distance& distance, const Predicate& is_measured, const Predicate& label) {
    std::vector<Index3> voxels;
    const Index3 low = Index3::Constant(-half_side), high = Index3::Constant(half_side);
    std::vector<Index3> origins;
    appendBlocks(low, high, origins);
    blocks_ = BlockSet(origins);
    distances_.assign(blocks_.valueCount(), kUnknown);
    for (std::size_t b = 0; b < blocks_.count(); ++b) {
      for (std::size_t i = 0; i < kBlockSize; ++i) {
        const Index3 v = blocks_.origin(b) + leafOffset(static_cast<int>(i));
        const double d = distance(v.cast<double>());
        if (std::abs(d) > 2 || !is_measured(v.cast<double>())) continue;
        voxels.push_back(v);
        distances_[b * kBlockSize + i] = static_cast<float>(d);
      }
    }
    support_.emplace(test::supportAt(voxels));
    octree_ = buildOctree(*support_, 0.5f, Box(low.cast<double>(), high.cast<double>()));
    tiles_ = tileCells(octree_);
    for (std::size_t c = 0; c < octree_.cellCount(); ++c) {
      const Vector3d centre =
          octree_.lowest(c).cast<double>() + Vector3d::Constant(0.5 * (octree_.side(c) - 1));
      const bool is_near = octree_.levels[c] == 0 && support_->at(octree_.lowest(c)) > 0;
      labels_.push_back((is_near ? distance(centre) < 0 : label(centre)) ? CellLabel::Inside
                                                                         : CellLabel::Outside);
    }
    cell_support_ = sampleCells(octree_, *support_, 0.5f);
    sigma_.assign(octree_.cellCount(), 0.0f);
    energy_.border = Border::Free, energy_.lambda = 1;
  }

  void setEvidence(const Distance& sigma) {
    for (std::size_t c = 0; c < octree_.cellCount(); ++c)
      sigma_[c] = static_cast<float>(
          sigma(octree_.lowest(c).cast<double>() + Vector3d::Constant(0.5 * (octree_.side(c) - 1))));
  }

  Completion complete() const {
    return completeSurface({octree_, labels_, cell_support_, sigma_, energy_}, tiles_,
                           {*support_, 0.3f, blocks_, distances_}, {});
  }

  /// Points of the completed surface on the edges between voxels.
  std::vector<Vector3d> fill(const Completion& completion) const {
    BlockField field{{1.0}, blocks_, std::vector<float>(blocks_.valueCount())};
    for (std::size_t b = 0; b < blocks_.count(); ++b)
      completion.readDistances(blocks_.origin(b), field.block(b));
    std::vector<Vector3d> points;
    for (std::size_t b = 0; b < blocks_.count(); ++b) {
      PaddedBlock<0, 1> near;
      loadPadded(blocks_, field.values.data(), b, kUnknown, near);
      for (int i = 0; i < static_cast<int>(kBlockSize); ++i) {
        const Index3 c = leafOffset(i);
        for (int axis = 0; axis < 3; ++axis) {
          const float one = near.at(c), other = near.at(c + Index3(Index3::Unit(axis)));
          if (!((one > 0) != (other > 0)) || std::isnan(one) || std::isnan(other)) continue;
          points.push_back((blocks_.origin(b) + c).cast<double>() +
                           one / (one - other) * Vector3d::Unit(axis));
        }
      }
    }
    return points;
  }

  const BlockSet& blocks() const { return blocks_; }
  const std::vector<float>& distances() const { return distances_; }
  const Octree& octree() const { return octree_; }

 private:
  BlockSet blocks_;
  std::vector<float> distances_;
  std::optional<ScalarGrid> support_;
  Octree octree_;
  CellTiles tiles_;
  std::vector<CellLabel> labels_;
  std::vector<float> cell_support_, sigma_;
  CutOptions energy_;
};

struct Errors {
  double mean = 0, largest = 0;
  std::size_t count = 0;
};
Errors errorsOf(const std::vector<Vector3d>& points, const Distance& distance) {
  Errors errors;
  for (const Vector3d& p : points) {
    const double error = std::abs(distance(p));
    errors.mean += error / static_cast<double>(points.size());
    errors.largest = std::max(errors.largest, error);
  }
  errors.count = points.size();
  return errors;
}

Instance planarHole(const Vector3d& normal, double offset, double radius, double depth) {
  const Distance distance = [=](const Vector3d& p) { return normal.dot(p) - offset; };
  const auto from_axis = [=](const Vector3d& p) { return (p - normal.dot(p) * normal).norm(); };
  // The cut has left a pit with steep walls.
  return {60, distance, [=](const Vector3d& p) { return from_axis(p) > radius; },
          [=](const Vector3d& p) { return distance(p) < (from_axis(p) < 0.8 * radius ? -depth : 0.0); }};
}

TEST(Completion, ClosesAPlanarHoleByAPlane) {
  for (const Vector3d& direction : {Vector3d(0, 0, 1), Vector3d(1, 2, 3), Vector3d(1, 1, 0)}) {
    const Vector3d normal = direction.normalized();
    const Instance hole = planarHole(normal, 0.3, 45, 7);
    const Errors errors =
        errorsOf(hole.fill(hole.complete()), [&](const Vector3d& p) { return normal.dot(p) - 0.3; });
    EXPECT_GT(errors.count, 5000u);
    EXPECT_LE(errors.mean, 0.25) << direction.transpose();
    EXPECT_LE(errors.largest, 0.7) << direction.transpose();
  }
}

TEST(Completion, BetweenTwoRingsIsACatenoid) {
  constexpr double kWaist = 24, kHalf = 10;
  const Vector3d axis = Vector3d(1, 2, 3).normalized();
  const auto radius = [](double z) { return kWaist * std::cosh(z / kWaist); };
  const Distance distance = [=](const Vector3d& p) {
    const double z = axis.dot(p), r = (p - z * axis).norm();
    return (r - radius(z)) / std::cosh(z / kWaist);  // the slope of the surface is sinh
  };
  const Instance rings(
      50, distance, [=](const Vector3d& p) { return std::abs(axis.dot(p)) > kHalf; },
      [=](const Vector3d& p) {
        const double z = axis.dot(p);
        return std::abs(z) > kHalf ? distance(p) < 0 : (p - z * axis).norm() < kWaist + 4;
      });
  const Errors errors = errorsOf(rings.fill(rings.complete()), distance);
  EXPECT_GT(errors.count, 2000u);
  EXPECT_LE(errors.largest, 1.0);
  EXPECT_LE(errors.mean, 0.7);  // its neck is soft: little area for a large move
}

TEST(Completion, LeavesWhatWasMeasuredAlone) {
  const Instance hole = planarHole(Vector3d(1, 2, 3).normalized(), 0.3, 20, 5);
  const Completion completion = hole.complete();
  std::vector<float> sides(kBlockSize), distances(kBlockSize);
  for (std::size_t b = 0; b < hole.blocks().count(); ++b) {
    completion.readSides(hole.blocks().origin(b), sides.data());
    completion.readDistances(hole.blocks().origin(b), distances.data());
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const float measured = hole.distances()[b * kBlockSize + i];
      if (std::isnan(measured)) continue;
      ASSERT_GE(sides[i] * measured, 0);
      ASSERT_TRUE(std::isnan(distances[i]));
    }
  }
}

TEST(Completion, BulgesAsFarAsTheEvidencePays) {
  // A pressure f over a surface of tension 1 makes a cap of radius 2/f: with faces weighing 3/2 of an area,
  // f = 2/3 of λ σ.
  const Vector3d normal = Vector3d::UnitZ();
  Instance hole = planarHole(normal, 0.3, 25, 3);
  constexpr double kCapRadius = 60;
  hole.setEvidence([](const Vector3d& p) { return p.z() < 30 ? -1.5 * 2 / kCapRadius : 0.0; });
  const double sunk = std::sqrt(kCapRadius * kCapRadius - 25 * 25);
  const Errors errors = errorsOf(hole.fill(hole.complete()), [&](const Vector3d& p) {
    return (p - Vector3d(0, 0, 0.3 - sunk)).norm() - kCapRadius;
  });
  EXPECT_GT(errors.count, 1500u);
  EXPECT_LE(errors.largest, 0.8);
}

TEST(Completion, IsTheSameForEveryNumberOfThreadsAndReportsItsGap) {
  const Instance hole = planarHole(Vector3d(1, 2, 3).normalized(), 0.3, 20, 5);
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const Completion completion = hole.complete();
    const CompletionReport& report = completion.report();
    EXPECT_GT(report.iterations, 0);
    EXPECT_GE(report.primal, report.dual);
    EXPECT_LE(report.primal - report.dual, 0.003 * report.area);
    std::vector<float>& all = results.emplace_back(hole.blocks().valueCount());
    for (std::size_t b = 0; b < hole.blocks().count(); ++b) {
      completion.readDistances(hole.blocks().origin(b), &all[b * kBlockSize]);
      std::replace_if(
          all.begin(), all.end(), [](float v) { return std::isnan(v); }, 99.0f);
    }
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(Completion, FindsNothingToDoWhereEverythingWasMeasured) {
  const Distance sphere = [](const Vector3d& p) { return p.norm() - 12.4; };
  const Instance closed(
      24, sphere, [](const Vector3d&) { return true; }, [&](const Vector3d& p) { return sphere(p) < 0; });
  const Completion completion = closed.complete();
  EXPECT_TRUE(closed.fill(completion).empty());
  std::vector<Index3> blocks;
  completion.appendBlocksTo(blocks);
  EXPECT_TRUE(blocks.empty());
}

}  // namespace
}  // namespace vdbfuse
