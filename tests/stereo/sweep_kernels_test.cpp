// SPDX-License-Identifier: Apache-2.0
#include "stereo/sweep_kernels.h"

#include <gtest/gtest.h>

#include <random>

#include "stereo/each_target.h"
#include "stereo/reference_level.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kWidth = 160, kHeight = 70, kShift = 5;

// Smooth noise.
Image<float> texture() {
  std::mt19937 random(1);
  Image<float> noise(kWidth + kShift, kHeight), smooth(kWidth + kShift, kHeight);
  for (float& value : noise) value = static_cast<float>(random() % 1000) / 1000;
  for (int y = 1; y + 1 < kHeight; ++y)
    for (int x = 1; x + 1 < kWidth + kShift; ++x)
      for (int k = 0; k < 9; ++k) smooth(x, y) += noise(x + k % 3 - 1, y + k / 3 - 1) / 9;
  return smooth;
}

std::vector<PictureLevel> picture(int left) {
  static const Image<float> all = texture();
  Photograph photograph;
  photograph.camera = {kWidth, kHeight, 100, 100, 79.5, 34.5, {}};
  photograph.brightness = Image<float>(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) photograph.brightness(x, y) = all(x + left, y);
  return picturePyramid(photograph, 1);
}

// What the reference shows at x, the partner shows at x − kShift: 100·w pixels to the left at inverse depth
// w.
struct Pair {
  std::vector<PictureLevel> reference = picture(0), partner = picture(kShift);
  ReferenceLevel level;
  ImageMotion motion = imageMotion(reference[0].camera, RigidTransform::Identity(), partner[0].camera,
                                   RigidTransform(Eigen::Translation3d(1, 0, 0)));
  SweepRange range{-0.08F, 0.01F, 17};  // a pixel a step, the right one in the middle
  SweepLimits limits{0.3F, 1};

  explicit Pair(int radius = 3) : level(referenceLevel(reference[0], radius, 0.001F)) {}
  SweepTile tile(const TileRect& rect) const {
    SweepTile result;
    prepareTile(level, rect, 0.01F * kShift, result);
    return result;
  }
  BestPeaks best(const SweepTile& tile) const {
    SweepMemory memory;
    BestPeaks peaks;
    sweepForBest(tile, partner[0], motion, range, limits, memory, peaks);
    return peaks;
  }
};

TEST(SweepKernels, AShiftedPictureIsFoundWhereItWasShiftedTo) {
  for (const int radius : {1, 2, 3, 4}) {
    const Pair pair(radius);
    const SweepTile tile = pair.tile({20, 10, 115, 48});
    const BestPeaks best = pair.best(tile);
    for (int y = 0; y < tile.height; ++y) {
      for (int x = 0; x < tile.width; ++x) {
        const std::size_t pixel = tile.at(x, y);
        ASSERT_NEAR(best.score[pixel], 1, 1e-3F) << radius << ' ' << x << ' ' << y;
        ASSERT_NEAR(best.step[pixel], 8, 0.5F);
        ASSERT_GT(best.curvature[pixel], 0);
      }
    }
  }
}

TEST(SweepKernels, TheBestOfAllPeaksIsTheBestPeak) {
  const Pair pair;
  const SweepTile tile = pair.tile({0, 0, 128, 48});
  const BestPeaks best = pair.best(tile);
  PeakLists lists;
  lists.clear(tile, 2);
  SweepMemory memory;
  sweepForAll(tile, pair.partner[0], pair.motion, pair.range, pair.limits, 1, memory, lists);
  std::size_t several = 0;
  for (std::size_t pixel = 0; pixel < lists.pixels; ++pixel) {
    float score = kNoPeak;
    for (std::size_t k = 0; k < kMostPeaks; ++k)
      score = std::max(score, lists.score[(kMostPeaks + k) * lists.pixels + pixel]);
    ASSERT_EQ(score, best.score[pixel]) << pixel;
    several += lists.counts[lists.pixels + pixel] > 1;
  }
  EXPECT_GT(several, 100U);
}

TEST(SweepKernels, TheResultDoesNotDependOnTheTile) {
  const Pair pair;
  const SweepTile one = pair.tile({0, 0, 128, 48}), other = pair.tile({37, 11, 75, 59});
  const BestPeaks from_one = pair.best(one), from_other = pair.best(other);
  for (int y = 11; y < 48; ++y) {
    for (int x = 37; x < 112; ++x) {
      const std::size_t a = one.at(x, y), b = other.at(x - 37, y - 11);
      ASSERT_EQ(from_one.score[a], from_other.score[b]) << x << ' ' << y;
      if (from_one.score[a] == kNoPeak) continue;
      ASSERT_EQ(from_one.step[a], from_other.step[b]);
      ASSERT_EQ(from_one.curvature[a], from_other.curvature[b]);
    }
  }
}

// Rows with a few, with one and without any windows, and pieces that wander.
TEST(SweepKernels, WindowsThatAreLeftOutDoNotChangeTheOthers) {
  const Pair pair;
  const SweepTile all = pair.tile({0, 0, 128, 60});
  const BestPeaks expected = pair.best(all);
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    SweepTile some = all;
    for (int y = 0; y < some.height; ++y) {
      const int begin = static_cast<int>(random() % 160), end = begin + static_cast<int>(random() % 40);
      for (int x = 0; x < some.width; ++x)
        if (x < begin || x >= end || y % 20 > 12) some.inverse_spread[some.at(x, y)] = 0;
    }
    const BestPeaks best = pair.best(some);
    for (std::size_t pixel = 0; pixel < best.score.size(); ++pixel) {
      const float score = some.inverse_spread[pixel] > 0 ? expected.score[pixel] : kNoPeak;
      ASSERT_EQ(best.score[pixel], score) << round << ' ' << pixel;
    }
  }
}

// Away from the border, where rounding says what lies in the picture; of two samples it may make equals.
TEST(SweepKernels, AllInstructionSetsFindTheSame) {
  const Pair pair;
  const SweepTile tile = pair.tile({24, 8, 96, 48});
  const BestPeaks expected = pair.best(tile);
  test::forEachTarget([&] {
    const BestPeaks best = pair.best(tile);
    std::size_t different = 0;
    for (std::size_t pixel = 0; pixel < best.score.size(); ++pixel) {
      const bool is_same =
          std::abs(best.score[pixel] - expected.score[pixel]) < 1e-3F &&
          (best.score[pixel] == kNoPeak || std::abs(best.step[pixel] - expected.step[pixel]) < 1e-2F);
      different += !is_same;
    }
    EXPECT_LT(different, 6U);
  });
}

}  // namespace
}  // namespace vdbfuse::stereo
