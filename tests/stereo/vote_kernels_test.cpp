// SPDX-License-Identifier: Apache-2.0
#include "stereo/vote_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stereo/each_target.h"
#include "stereo/votes.h"

namespace vdbfuse::stereo {
namespace {

constexpr float kSigma = 2;
constexpr std::size_t kPixels = 1600, kPartners = 4, kVoters = 9;

struct Rows {
  AlignedFloats step, score, curvature;
};

// Around three depths, so that voters agree and disagree; a third of them does not vote.
std::vector<Rows> randomVoters(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<float>(random() % 100003) / 100003; };
  std::vector<Rows> voters(kVoters);
  for (Rows& rows : voters) {
    for (std::size_t i = 0; i < kPixels; ++i) {
      rows.step.push_back(20 * static_cast<float>(random() % 3) + 6 * uniform());
      rows.score.push_back(random() % 3 == 0 ? kNoPeak : 0.3F + 0.7F * uniform());
      rows.curvature.push_back(0.05F + uniform());
    }
  }
  return voters;
}

ModeRows counted(const std::vector<Rows>& voters) {
  std::vector<VoterRows> rows;
  for (const Rows& voter : voters)
    rows.push_back({voter.step.data(), voter.score.data(), voter.curvature.data()});
  ModeRows modes;
  countVotes(rows, kPartners, kSigma, voters.front().step.size(), modes);
  return modes;
}

std::vector<Peak> peaksOf(const std::vector<Rows>& voters, std::size_t pixel) {
  std::vector<Peak> peaks;
  for (std::size_t j = 0; j < voters.size(); ++j) {
    const auto number = static_cast<std::int32_t>(j < kPartners ? j : j + kOtherViews);
    const Rows& rows = voters[j];
    if (rows.score[pixel] > 0)
      peaks.push_back({rows.step[pixel], rows.score[pixel], rows.curvature[pixel], number});
  }
  return peaks;
}

float countAt(const std::vector<Peak>& peaks, float step) {
  float sum = 0;
  for (const Peak& peak : peaks) {
    const float place = (peak.step - step) / kSigma;
    if (std::abs(place) < 4) sum += peak.score * std::exp(-place * place / 2);
  }
  return sum;
}

void expectThoseOfOnePixel(const ModeRows& modes, const std::vector<Rows>& voters) {
  Voting voting(kSigma, 1);
  std::size_t ties = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const Modes& expected = voting.count(peaksOf(voters, i));
    ASSERT_EQ(expected.size(), 1u);
    // Two modes of the same height: rounding chooses.
    if (std::abs(expected[0].step - modes.step[i]) > 1 && ++ties <= 2) continue;
    EXPECT_NEAR(modes.step[i], expected[0].step, 2e-3F);
    EXPECT_NEAR(modes.score[i], expected[0].score, 2e-3F);
    EXPECT_NEAR(modes.support[i], expected[0].support, 2e-3F);
    EXPECT_EQ(modes.voters[i], expected[0].voters);
    EXPECT_NEAR(modes.spread2[i], expected[0].spread2, 4e-3F);
  }
}

TEST(VoteKernels, AgreeWithTheVotesOfOnePixel) {
  const std::vector<Rows> voters = randomVoters(1);
  test::forEachTarget([&] { expectThoseOfOnePixel(counted(voters), voters); });
}

TEST(VoteKernels, TheSecondBestIsTheBestPeakWellApart) {
  const std::vector<Rows> voters = randomVoters(2);
  const ModeRows modes = counted(voters);
  std::size_t found = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    const std::vector<Peak> peaks = peaksOf(voters, i);
    float expected = 0;
    for (const Peak& peak : peaks)
      if (std::abs(peak.step - modes.step[i]) >= 3 * kSigma)
        expected = std::max(expected, countAt(peaks, peak.step));
    EXPECT_NEAR(modes.second[i], expected, 1e-5F);
    found += expected > 0;
  }
  EXPECT_GT(found, kPixels / 2);
}

TEST(VoteKernels, APixelDoesNotDependOnThoseBesideIt) {
  const std::vector<Rows> voters = randomVoters(3);
  const ModeRows all = counted(voters);
  constexpr std::size_t kMoved = 3;
  std::vector<Rows> others = randomVoters(4);
  for (std::size_t j = 0; j < kVoters; ++j) {
    for (std::size_t i = 0; i + kMoved < kPixels; i += 7) {
      others[j].step[i + kMoved] = voters[j].step[i];
      others[j].score[i + kMoved] = voters[j].score[i];
      others[j].curvature[i + kMoved] = voters[j].curvature[i];
    }
  }
  const ModeRows modes = counted(others);
  for (std::size_t i = 0; i + kMoved < kPixels; i += 7) {
    EXPECT_EQ(modes.step[i + kMoved], all.step[i]);
    EXPECT_EQ(modes.score[i + kMoved], all.score[i]);
    EXPECT_EQ(modes.support[i + kMoved], all.support[i]);
    EXPECT_EQ(modes.second[i + kMoved], all.second[i]);
    EXPECT_EQ(modes.spread2[i + kMoved], all.spread2[i]);
  }
}

TEST(VoteKernels, WhereNobodyVotesThereIsNothing) {
  std::vector<Rows> voters = randomVoters(4);
  for (Rows& rows : voters) std::fill(rows.score.begin(), rows.score.begin() + 20, kNoPeak);
  const ModeRows modes = counted(voters);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(modes.score[i] + modes.support[i], 0);
    EXPECT_EQ(modes.second[i], 0);
    EXPECT_EQ(modes.voters[i], 0);
  }
  EXPECT_GT(modes.score[20] + modes.support[20], 0);
}

}  // namespace
}  // namespace vdbfuse::stereo
