// SPDX-License-Identifier: Apache-2.0
// Part (b) of the proof, on real data: the logistic member and the Curless-Levoy sum have the same zero set.
#include <gtest/gtest.h>

#include <limits>

#include "io/shared_data.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/surface/extract.h"

namespace vdbfuse {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Leaves of 20 mm voxels around every 64th measured pixel of the first view.
std::vector<Index3> someLeaves(const View& view, const GridFrame& frame) {
  std::vector<Index3> origins;
  for (int y = 8; y < view.map.depth.height(); y += 32) {
    for (int x = 8; x < view.map.depth.width(); x += 32) {
      if (view.map.depth(x, y) == kInvalidDepth) continue;
      origins.push_back(leafOrigin(frame.toIndex(worldPoint(view, x, y)).array().round().cast<int>()));
    }
  }
  return origins;
}

TEST(CurlessLevoy, OnRealDataTheLogisticMemberIsTheSumAndHasTheSameSurface) {
  const auto folder = test::sharedData("kitchen-rgbd");
  if (!folder) GTEST_SKIP() << "kitchen-rgbd is absent: set VDBFUSE_DATA to the folder that holds it";
  const DepthSet set = readDepthSet(*folder);
  std::vector<View> views;
  for (std::size_t i = 0; i < 4; ++i) views.push_back(set.views.load(8 * i));
  const GridFrame frame{0.02};
  const std::vector<Index3> origins = someLeaves(views.front(), frame);
  const JudgedViews judged =
      believe(std::move(views), {logisticNoise(), {0.004, 0.002, 0}, -kInfinity, kInfinity}, 0.0);
  ScalarGrid evidence("evidence", frame, kUnknown, origins), sum("sum", frame, kUnknown, origins);
  EvidenceOptions options;
  options.rule = EvidenceRule::NoSelfOcclusion;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < evidence.leafCount(); ++i) {
    const ScalarGrid::Leaf leaf = evidence.leaf(i);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
      points.push_back(frame.toWorld(Index3(leaf.origin + Index3(k >> 6, k >> 3 & 7, k & 7))));
    const std::vector<float> e = evidenceAt(judged, points, options);
    const std::vector<double> s = untruncatedSum(judged, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      // Float rounding of the sum of four.
      ASSERT_NEAR(e[k], s[k], 1e-6 * (4 + 4 * std::abs(s[k])));
      if (s[k] == 0.0) continue;
      leaf.values[k] = e[k], sum.leaf(i).values[k] = static_cast<float>(s[k]);
      ++compared;
    }
  }
  EXPECT_GT(compared, 20000u);
  const TriangleMesh a = extractSurface(evidence), b = extractSurface(sum);
  EXPECT_GT(a.triangles.size(), 1000u);
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    EXPECT_LT((a.vertices[v] - b.vertices[v]).norm(), 1e-3 * frame.voxel);
}

}  // namespace
}  // namespace vdbfuse
