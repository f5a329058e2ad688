// SPDX-License-Identifier: Apache-2.0
#include "pipeline/packed_images.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdbfuse/base/random.h"
#include "vdbfuse/base/scratch_memory.h"

namespace vdbfuse {
namespace {

const std::shared_ptr<std::pmr::memory_resource> kPlain{std::shared_ptr<void>(),
                                                        std::pmr::new_delete_resource()};

DepthMap everything(double quantum) {
  Random random(3);
  DepthMap map;
  map.depth = Image<float>(320, 240);
  map.confidence = Image<float>(320, 240, 0.25f);
  map.color = Image<Rgb8>(160, 120, {1, 2, 3});
  map.mask = Image<std::uint8_t>(320, 240, 1);
  map.alternatives.push_back({Image<float>(320, 240, 2.0f), Image<float>(320, 240, 0.5f)});
  for (float& depth : map.depth) {
    const double d = random.uniform(0, 4);
    depth = static_cast<float>(quantum > 0 ? quantum * std::floor(d / quantum) : d);
  }
  return map;
}

void expectTheSame(const DepthMap& a, const DepthMap& b) {
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.confidence, b.confidence);
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.mask, b.mask);
  ASSERT_EQ(a.alternatives.size(), b.alternatives.size());
  EXPECT_EQ(a.alternatives[0].depth, b.alternatives[0].depth);
  EXPECT_EQ(a.alternatives[0].share, b.alternatives[0].share);
}

TEST(PackedImages, ComeBackToTheLastBit) {
  for (const double quantum : {0.001, 0.0}) {
    const DepthMap map = everything(quantum);
    expectTheSame(PackedImages(map, kPlain).unpack(), map);
    const auto file = std::make_shared<ScratchMemory>(0);
    const DepthMap back = PackedImages(map, file).unpack();
    expectTheSame(back, map);
    EXPECT_EQ(back.depth.memory(), std::pmr::new_delete_resource());
  }
}

TEST(PackedImages, TakeTwoBytesForADepthOfASensorThatMeasuresInSteps) {
  DepthMap steps, none;
  steps.depth = everything(0.001).depth, none.depth = everything(0).depth;
  EXPECT_EQ(PackedImages(steps, kPlain).bytes(), 320u * 240 * 2 + 4000 * 4);
  EXPECT_EQ(PackedImages(none, kPlain).bytes(), 320u * 240 * 4);
}

TEST(PackedImages, TakeNoMoreThanTheDepthsWhereATableWouldNotPay) {
  DepthMap map;
  map.depth = Image<float>(100, 100);
  for (std::size_t p = 0; p < map.depth.size(); ++p) map.depth.data()[p] = 1.0f + static_cast<float>(p);
  EXPECT_EQ(PackedImages(map, kPlain).bytes(), 100u * 100 * 4);
  EXPECT_EQ(PackedImages(map, kPlain).unpack().depth, map.depth);
}

TEST(PackedImages, TellNumbersApartThatAreEqualButNotTheSame) {
  DepthMap map;
  map.depth = Image<float>(2, 1);
  map.depth(1, 0) = -0.0f;
  EXPECT_TRUE(std::signbit(PackedImages(map, kPlain).unpack().depth(1, 0)));
}

}  // namespace
}  // namespace vdbfuse
