// SPDX-License-Identifier: Apache-2.0
#include "stereo/paper_votes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "stereo/matching_constants.h"
#include "stereo/paper_curve.h"

namespace vdbfuse::stereo::paper {
namespace {

std::vector<Vote> randomVotes(int seed, int count) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::vector<Vote> votes;
  for (int i = 0; i < count; ++i)
    votes.push_back({static_cast<double>(random() % 4000) / 100,
                     0.5 + static_cast<double>(random() % 50) / 100, static_cast<std::size_t>(i / 3)});
  return votes;
}

TEST(LocalMaxima, TheParabolaThroughThreeSamplesIsExactForAParabola) {
  std::vector<double> curve;
  for (int k = 0; k < 9; ++k) curve.push_back(0.9 - 0.05 * (k - 4.3) * (k - 4.3));
  const std::vector<Vote> maxima = localMaxima(curve, 0.5, 2);
  ASSERT_EQ(maxima.size(), 1u);
  EXPECT_NEAR(maxima[0].step, 4.3, 1e-12);
  EXPECT_NEAR(maxima[0].score, 0.9, 1e-12);
  EXPECT_EQ(maxima[0].partner, 2u);
}

TEST(LocalMaxima, AllAboveTheThresholdVoteAndNoneBelowIt) {
  const std::vector<double> curve{0, 0.6, 0, 0.4, 0, 0.9, 0.9, 0.2};
  const std::vector<Vote> maxima = localMaxima(curve, 0.5, 0);
  ASSERT_EQ(maxima.size(), 2u);
  EXPECT_NEAR(maxima[0].step, 1, 1e-12);
  EXPECT_NEAR(maxima[1].step, 5.5, 1e-12);  // of two equal samples one counts
}

TEST(LocalMaxima, TheEndsOfACurveAndOfItsPartsAreNone) {
  EXPECT_TRUE(localMaxima({0.9, 0.2, 0.1, 0.8}, 0.5, 0).empty());
  EXPECT_TRUE(localMaxima({0.1, 0.9, kNoScore, 0.8, 0.3}, 0.5, 0).empty());
  EXPECT_TRUE(localMaxima({}, 0.5, 0).empty());
}

TEST(ModesOf, TheBestIsWhereAFineSearchFindsTheGreatestSumOfVotes) {
  for (int seed = 0; seed < 50; ++seed) {
    const std::vector<Vote> votes = randomVotes(seed, 12);
    double best = 0;
    for (double step = -1; step < 41; step += 0.001) best = std::max(best, votesAt(votes, step));
    const std::vector<Mode> modes = modesOf(votes);
    EXPECT_NEAR(modes.front().score, best, 1e-5) << seed;
    EXPECT_EQ(modes.front().score, votesAt(votes, modes.front().step));
  }
}

TEST(ModesOf, EachIsThreeSigmaFromAllBetterOnes) {
  for (int seed = 0; seed < 50; ++seed) {
    const std::vector<Mode> modes = modesOf(randomVotes(seed, 12));
    for (std::size_t i = 1; i < modes.size(); ++i) {
      EXPECT_LE(modes[i].score, modes[i - 1].score);
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(std::abs(modes[i].step - modes[j].step), 3 * kVoteSigma);
    }
  }
}

TEST(ModesOf, PartnersThatAgreeOutvoteASurerOne) {
  const std::vector<Mode> modes = modesOf({{10, 0.95, 0}, {20, 0.6, 0}, {20.4, 0.6, 1}});
  ASSERT_EQ(modes.size(), 2u);
  EXPECT_NEAR(modes[0].step, 20.2, 1e-3);
  EXPECT_NEAR(modes[1].step, 10, 1e-3);  // the far votes pull by e^−12
}

TEST(ModesOf, OfEqualOnesTheFirstVoteWins) {
  EXPECT_EQ(modesOf({{30, 0.8, 0}, {10, 0.8, 1}}).front().step, 30);
  EXPECT_TRUE(modesOf({}).empty());
}

TEST(ModesOfMean, AStepIsTheMeanOfThosePartnersThatHaveAScoreThere) {
  const double x = kNoScore;
  const std::vector<Mode> modes =
      modesOfMean({{0.1, 0.2, 0.8, 0.2, x}, {x, 0.0, 0.4, 0.0, 0.5}, {x, x, x, x, x}});
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].step, 2, 1e-12);
  EXPECT_NEAR(modes[0].score, 0.6, 1e-12);
  EXPECT_TRUE(modesOfMean({}).empty());
}

TEST(VotersAt, APartnerCountsOnceHoweverOftenItVotes) {
  const std::vector<Vote> votes{{10, 0.9, 0}, {11, 0.9, 0}, {11.5, 0.9, 1}, {13, 0.9, 2}};
  EXPECT_EQ(votersAt(votes, 10), 2u);
  EXPECT_EQ(votersAt(votes, 30), 0u);
}

}  // namespace
}  // namespace vdbfuse::stereo::paper
