// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace vdbfuse {
namespace {

// An independent SplitMix64, seeded as the published reference is.
std::uint64_t splitMix(std::uint64_t& state) {
  std::uint64_t z = state += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

TEST(Random, TheReferenceIsThePublishedGenerator) {
  std::uint64_t state = 1234567;  // with the first values that are published for it
  EXPECT_EQ(splitMix(state), 6457827717110365317ULL);
  EXPECT_EQ(splitMix(state), 3203168211198807973ULL);
}

TEST(Random, TheSequenceIsFixedForEver) {
  // state = mix(seed + golden) xor mix(~stream · golden), written with the reference's own mixing.
  std::uint64_t a = 1, b = ~std::uint64_t{2} * 0x9e3779b97f4a7c15ULL - 0x9e3779b97f4a7c15ULL;
  std::uint64_t state = splitMix(a) ^ splitMix(b);
  Random random(1, 2);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(random.next(), splitMix(state));
}

TEST(Random, StreamsAndSeedsDiffer) {
  EXPECT_NE(Random(1, 0).next(), Random(1, 1).next());
  EXPECT_NE(Random(1, 0).next(), Random(2, 0).next());
  EXPECT_NE(Random(1, 2).next(), Random(2, 1).next());
  EXPECT_EQ(Random(7, 3).next(), Random(7, 3).next());
}

TEST(Random, UniformHasItsMeanVarianceAndRange) {
  Random random(5);
  double sum = 0, squares = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double u = random.uniform();
    ASSERT_TRUE(u >= 0 && u < 1);
    sum += u, squares += u * u;
  }
  EXPECT_NEAR(sum / kCount, 0.5, 0.003);
  EXPECT_NEAR(squares / kCount - sum * sum / kCount / kCount, 1.0 / 12, 0.001);
}

TEST(Random, NormalHasItsFirstFourMoments) {
  Random random(6);
  std::array<double, 5> moments{};
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    for (std::size_t k = 1; k < moments.size(); ++k)
      moments[k] += std::pow(x, static_cast<double>(k)) / kCount;
  }
  EXPECT_NEAR(moments[1], 0, 0.01);
  EXPECT_NEAR(moments[2], 1, 0.02);
  EXPECT_NEAR(moments[3], 0, 0.04);
  EXPECT_NEAR(moments[4], 3, 0.1);
}

TEST(Random, BelowIsEvenOverItsValues) {
  Random random(8);
  std::array<int, 5> counts{};
  for (int i = 0; i < 50000; ++i) ++counts.at(random.below(5));
  for (const int c : counts) EXPECT_NEAR(c, 10000, 400);
}

}  // namespace
}  // namespace vdbfuse
