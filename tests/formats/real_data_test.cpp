// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/shared_data.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {
namespace {

// Signed differences between the depth that view `a` predicts in view `b` and what `b` measured there, for
// pixels that see the same surface (within `gate`); and how many were looked at.
struct Reprojection {
  std::vector<double> differences;
  std::size_t looked_at = 0;
  double agreeing() const { return static_cast<double>(differences.size()) / static_cast<double>(looked_at); }
  double medianSize() const {
    std::vector<double> sizes;
    for (const double d : differences) sizes.push_back(std::abs(d));
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2),
                     sizes.end());
    return sizes[sizes.size() / 2];
  }
};

Reprojection reproject(const View& a, const View& b, const RigidTransform& b_from_a, double gate) {
  Reprojection result;
  for (int y = 0; y < a.map.depth.height(); ++y) {
    for (int x = 0; x < a.map.depth.width(); ++x) {
      if (a.map.depth(x, y) == kInvalidDepth) continue;
      const auto hit = project(b.projection, b_from_a * unproject(a.projection, x, y, a.map.depth(x, y)));
      if (!hit) continue;
      const int u = nearestPixel(hit->x), v = nearestPixel(hit->y);
      if (!b.map.depth.contains(u, v) || b.map.depth(u, v) == kInvalidDepth) continue;
      ++result.looked_at;
      const double difference = b.map.depth(u, v) - hit->depth;
      if (std::abs(difference) < gate) result.differences.push_back(difference);
    }
  }
  return result;
}

// Neighbours must agree with the poses as read, and agree worse with the inverse poses.
void expectAgreement(const ViewSequence& views, std::size_t step, double gate, double median) {
  for (std::size_t i = 0; i + step < views.size(); i += 3 * step) {
    const View a = views.load(i), b = views.load(i + step);
    const Reprojection right = reproject(a, b, b.world_from_camera.inverse() * a.world_from_camera, gate);
    const Reprojection wrong = reproject(a, b, b.world_from_camera * a.world_from_camera.inverse(), gate);
    ASSERT_GT(right.looked_at, 10000u) << a.name;
    EXPECT_GT(right.agreeing(), 0.85) << a.name << " and " << b.name;
    EXPECT_LT(right.medianSize(), median) << a.name << " and " << b.name;
    EXPECT_GT(right.agreeing(), wrong.agreeing()) << a.name << " and " << b.name;
  }
}

TEST(RealData, ShelfHasFiftyViewsThatAgreeToMillimetres) {
  const auto folder = test::sharedData("shelf-rgbd");
  if (!folder) GTEST_SKIP() << "the real data set shelf-rgbd is not on this machine (set VDBFUSE_DATA)";
  const DepthSet set = readDepthSet(*folder);
  EXPECT_EQ(set.format, "rgbd");
  EXPECT_EQ(set.notes.size(), 0u);
  ASSERT_EQ(set.views.size(), 50u);
  const View view = set.views.load(0);
  EXPECT_EQ(view.name, "frame-000015");
  EXPECT_EQ(view.map.depth.width(), 640);
  EXPECT_EQ(view.map.depth.height(), 480);
  EXPECT_TRUE(view.map.color.sameSize(view.map.depth));
  expectAgreement(set.views, 5, 0.02, 0.003);
}

TEST(RealData, KitchenHasAHundredViewsThatAgreeToCentimetres) {
  const auto folder = test::sharedData("kitchen-rgbd");
  if (!folder) GTEST_SKIP() << "the real data set kitchen-rgbd is not on this machine (set VDBFUSE_DATA)";
  const DepthSet set = readDepthSet(*folder);
  EXPECT_EQ(set.format, "rgbd");
  EXPECT_EQ(set.notes, std::vector<std::string>{"colour for 10 of 100 views"});
  ASSERT_EQ(set.views.size(), 100u);
  EXPECT_EQ(imageWidth(set.views.header(0).projection), 640);
  EXPECT_FALSE(set.views.load(0).map.color.empty());
  EXPECT_TRUE(set.views.load(1).map.color.empty());
  expectAgreement(set.views, 10, 0.1, 0.01);
}

}  // namespace
}  // namespace vdbfuse
