// SPDX-License-Identifier: Apache-2.0
#include "surface/fragments.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

struct Sides {
  BlockField field{
      {1.0},
      BlockSet({{0, 0, 0}, {0, 0, 8}, {0, 8, 0}, {0, 8, 8}, {8, 0, 0}, {8, 0, 8}, {8, 8, 0}, {8, 8, 8}}),
      {}};
  std::vector<float> invented;
  Sides() : invented(field.blocks.valueCount(), 0.0f) { field.values.assign(invented.size(), 1.0f); }
  float& at(std::vector<float>& values, const Index3& v) const {
    return values[field.blocks.find(leafOrigin(v)) * kBlockSize + leafPlace(v)];
  }
  void set(const Index3& low, const Index3& high, float side) {
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) at(field.values, {x, y, z}) = side;
  }
};

TEST(DropFragments, TurnsSmallPiecesAndCavitiesAcrossBlocks) {
  for (const float side : {1.0f, -1.0f}) {
    Sides s;
    s.set({0, 0, 0}, {15, 15, 15}, side);
    s.set({7, 7, 7}, {8, 8, 8}, -side);
    s.at(s.invented, {7, 7, 7}) = 1;
    EXPECT_EQ(dropFragments(s.invented, 8, s.field), 1u);
    for (const float value : s.field.values) ASSERT_EQ(value, side);
  }
}

TEST(DropFragments, LeavesLargerOnesThoseAtTheEdgeAndThoseThatNothingInventedTouches) {
  Sides s;
  s.set({4, 4, 4}, {6, 5, 5}, -1);  // 12 voxels
  s.set({0, 12, 12}, {0, 12, 12}, -1);
  s.set({12, 12, 4}, {12, 12, 4}, -1);
  s.at(s.invented, {4, 4, 4}) = s.at(s.invented, {0, 12, 12}) = 1;
  const std::vector<float> before = s.field.values;
  EXPECT_EQ(dropFragments(s.invented, 8, s.field), 0u);
  EXPECT_EQ(s.field.values, before);
  s.at(s.invented, {12, 12, 5}) = 1;
  EXPECT_EQ(dropFragments(s.invented, 8, s.field), 1u) << "beside something invented";
}

TEST(DropFragments, JoinsInsidesAcrossEdgesAndOutsidesOnlyAcrossFaces) {
  for (const float side : {1.0f, -1.0f}) {
    Sides s;
    s.set({0, 0, 0}, {15, 15, 15}, side);
    s.set({4, 4, 4}, {5, 4, 4}, -side);
    s.set({6, 5, 4}, {7, 5, 4}, -side);  // across an edge
    for (float& mark : s.invented) mark = 1;
    EXPECT_EQ(dropFragments(s.invented, 3, s.field), side > 0 ? 0u : 2u);
  }
}

TEST(DropUnresolved, TurnsWhatFitsIntoACubeOfTwoVoxelsAndNothingLonger) {
  for (const float side : {1.0f, -1.0f}) {
    Sides s;
    s.set({0, 0, 0}, {15, 15, 15}, side);
    s.set({7, 7, 7}, {8, 8, 8}, -side);
    s.set({3, 3, 3}, {3, 3, 3}, -side);
    EXPECT_EQ(dropUnresolved(2, s.field), 2u);
    for (const float value : s.field.values) ASSERT_EQ(value, side);
    s.set({7, 7, 7}, {7, 7, 9}, -side);  // three voxels long
    const std::vector<float> before = s.field.values;
    EXPECT_EQ(dropUnresolved(2, s.field), 0u);
    EXPECT_EQ(s.field.values, before);
  }
}

TEST(DropUnresolved, LeavesAWireThatHangsTogetherByEdgesAndWhatReachesOutOfTheBlocks) {
  Sides s;
  for (int i = 4; i < 7; ++i) s.set({i, i, 8}, {i, i, 8}, -1);
  s.set({0, 12, 12}, {0, 12, 12}, -1);
  const std::vector<float> before = s.field.values;
  EXPECT_EQ(dropUnresolved(2, s.field), 0u);
  EXPECT_EQ(s.field.values, before);
}

}  // namespace
}  // namespace vdbfuse
