// SPDX-License-Identifier: Apache-2.0
// A video repeats its mistakes: ten times the same view must not count as ten witnesses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/scan_scenes.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mesh/winding_number.h"
#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {
namespace {

constexpr double kVoxel = 1.0 / 64;
const Box kDomain(Eigen::Vector3d::Constant(-0.55), Eigen::Vector3d::Constant(0.55));

ReconstructOptions options() {
  ReconstructOptions options;
  options.voxel = kVoxel;
  options.domain = kDomain;
  return options;
}

// The same image from almost the same place: the same noise and the same outliers.
View repeated(const View& view, std::uint64_t copy, std::uint64_t index) {
  Random random(copy, index);
  const auto tiny = [&random] { return 2e-4 * random.normal(); };
  View again = view;
  again.name += "-" + std::to_string(copy);
  const Eigen::Vector3d turn(tiny(), tiny(), tiny()), shift(tiny(), tiny(), tiny());
  again.world_from_camera.rotate(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  again.world_from_camera.translation() += shift;
  return again;
}

class RedundantViews : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new Scene(makeScene("torus"));
    SynthOptions synth;
    synth.views = 16, synth.noise_scale = 0.002, synth.confidence = ConfidenceKind::None;
    synth.outliers = 0.08;
    const std::vector<View> once = test::viewsOf(test::smallScan(*scene_, synth, 96));
    std::vector<View> ten_times;
    for (std::uint64_t copy = 0; copy < 10; ++copy)
      for (std::size_t i = 0; i < once.size(); ++i)
        ten_times.push_back(copy == 0 ? once[i] : repeated(once[i], copy, i));
    once_ = new JudgedScan(judgeScan(ViewSequence::fromViews(once), options()));
    ten_times_ = new JudgedScan(judgeScan(ViewSequence::fromViews(ten_times), options()));
  }
  static void TearDownTestSuite() {
    delete scene_;
    delete once_;
    delete ten_times_;
  }

  static TriangleMesh meshOf(const JudgedScan& scan) { return reconstruct(scan, options()).mesh; }

  // Voxels on other sides, over those within 5 % of the object's size from its surface.
  static double difference(const TriangleMesh& a, const TriangleMesh& b) {
    constexpr double kNear = 0.05;
    const WindingNumber in_a(a), in_b(b);
    double near = 0, different = 0;
    for (double z = -0.55; z < 0.55; z += kVoxel)
      for (double y = -0.55; y < 0.55; y += kVoxel)
        for (double x = -0.55; x < 0.55; x += kVoxel) {
          const Eigen::Vector3d p(x, y, z);
          near += std::abs(scene_->distance(p)) < kNear;
          different += in_a.inside(p) != in_b.inside(p);
        }
    return different / near;
  }

  static inline Scene* scene_ = nullptr;
  static inline JudgedScan *once_ = nullptr, *ten_times_ = nullptr;
};

TEST_F(RedundantViews, TenTimesTheSameSixteenGiveTheSameLabels) {
  const TriangleMesh once = meshOf(*once_), ten = meshOf(*ten_times_);
  EXPECT_GT(test::iouOf(once, scene_->truth), 0.95);
  EXPECT_LT(difference(once, ten), 0.01);
}

// Judging finds most of the mistakes; where it does not, the copies of a mistake confirm each other.
TEST_F(RedundantViews, WithoutTheWeightsTheyRepeatMistakesThatNobodyFound) {
  const auto unjudged = [](JudgedScan scan) {
    for (JudgedView& view : scan.judgement.judged.views)
      std::fill(view.outlier.begin(), view.outlier.end(), 0.08f);
    return scan;
  };
  const TriangleMesh once = meshOf(unjudged(*once_));
  JudgedScan weighted = unjudged(*ten_times_), unweighted = weighted;
  for (JudgedView& view : unweighted.judgement.judged.views) view.weight = 1;
  const double kept = difference(once, meshOf(weighted)), lost = difference(once, meshOf(unweighted));
  EXPECT_GT(lost, 0.1);
  EXPECT_LT(kept, 0.5 * lost);
}

TEST_F(RedundantViews, AreNotAskedAboutEachOther) {
  std::vector<const ViewHeader*> headers;
  for (const JudgedView& view : ten_times_->judgement.judged.views) headers.push_back(&view);
  const ViewGraph graph(headers, ten_times_->calibration.median_depth);
  const auto neighbours = chooseNeighbours(graph, headers.size());
  for (std::size_t i = 0; i < headers.size(); ++i) {
    EXPECT_GE(neighbours[i].size(), 4u);
    for (const std::size_t j : neighbours[i]) {
      EXPECT_NE(j % 16, i % 16);
      for (const std::size_t k : neighbours[i]) EXPECT_TRUE(j == k || j % 16 != k % 16);
    }
  }
}

}  // namespace
}  // namespace vdbfuse
