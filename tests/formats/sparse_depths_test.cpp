// SPDX-License-Identifier: Apache-2.0
#include "formats/sparse_depths.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

// Depths 101, 102, ..., 199, and one that is far off at either end.
TEST(SparseDepths, AreTheMiddleNinetyEightPercentAndATenth) {
  SparseDepths depths({RigidTransform::Identity(), RigidTransform(Eigen::Translation3d(0, 0, 100))});
  for (int i = 1; i <= 99; ++i) depths.add(1, {5, 0, 1.0 * i});
  depths.add(1, {0, 0, -99.5});
  depths.add(1, {0, 0, 1e6});
  const auto interval = depths.interval(1);
  ASSERT_TRUE(interval.has_value());
  EXPECT_NEAR(interval->near, 101 - 9.8, 1e-4);
  EXPECT_NEAR(interval->far, 199 + 9.8, 1e-4);
  EXPECT_FALSE(depths.interval(0).has_value());
}

TEST(SparseDepths, StayAboveHalfTheNearest) {
  SparseDepths depths({RigidTransform::Identity()});
  for (int i = 0; i < 8; ++i) depths.add(0, {0, 0, 1.0 + 10 * i});
  EXPECT_NEAR(depths.interval(0)->near, 0.5, 1e-6);
}

TEST(SparseDepths, NeedEightPointsInFrontThatDiffer) {
  SparseDepths depths({RigidTransform::Identity(), RigidTransform::Identity()});
  for (int i = 0; i < 7; ++i) depths.add(0, {0, 0, 1.0 + i});
  depths.add(0, {0, 0, -1});
  EXPECT_FALSE(depths.interval(0).has_value());
  for (int i = 0; i < 20; ++i) depths.add(1, {0, 0, 2});
  EXPECT_FALSE(depths.interval(1).has_value());
}

}  // namespace
}  // namespace vdbfuse
