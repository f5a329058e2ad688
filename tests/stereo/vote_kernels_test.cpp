// SPDX-License-Identifier: Apache-2.0
#include "stereo/vote_kernels.h"

#include <gtest/gtest.h>

#include <random>

#include "stereo/each_target.h"
#include "stereo/votes_of_one_pixel.h"

namespace vdbfuse::stereo {
namespace {

constexpr float kSigma = 2;
constexpr std::size_t kPixels = 1600;

struct Rows {
  AlignedFloats step, score, curvature;
};

// The first of all have several peaks, and are partners.
struct Voters {
  std::size_t partners = 4, others = 5, peaks_a_partner = 1;
  std::vector<Rows> rows;

  std::size_t partnerRows() const { return partners * peaks_a_partner; }
  int voter(std::size_t row) const {
    return static_cast<int>(row < partnerRows() ? row / peaks_a_partner : row);
  }
};

// Around three depths, so that voters agree and disagree; a third of the peaks is missing.
Voters randomVoters(unsigned seed, std::size_t peaks_a_partner = 1) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return static_cast<float>(random() % 100003) / 100003; };
  Voters voters;
  voters.peaks_a_partner = peaks_a_partner;
  voters.rows.resize(voters.partnerRows() + voters.others);
  for (Rows& rows : voters.rows) {
    for (std::size_t i = 0; i < kPixels; ++i) {
      rows.step.push_back(20 * static_cast<float>(random() % 3) + 6 * uniform());
      rows.score.push_back(random() % 3 == 0 ? kNoPeak : 0.3F + 0.7F * uniform());
      rows.curvature.push_back(0.05F + uniform());
    }
  }
  return voters;
}

std::vector<ModeRows> counted(const Voters& voters, std::size_t most = 1) {
  std::vector<VoterRows> rows;
  for (const Rows& row : voters.rows)
    rows.push_back({row.step.data(), row.score.data(), row.curvature.data(), voters.voter(rows.size())});
  std::vector<ModeRows> modes(most);
  countVotes(rows, voters.partnerRows(), kSigma, kPixels, modes);
  return modes;
}

std::vector<test::Peak> peaksOf(const Voters& voters, std::size_t pixel) {
  std::vector<test::Peak> peaks;
  for (std::size_t j = 0; j < voters.rows.size(); ++j) {
    const Rows& row = voters.rows[j];
    if (row.score[pixel] > 0)
      peaks.push_back({row.step[pixel], row.score[pixel], row.curvature[pixel], voters.voter(j),
                       j < voters.partnerRows()});
  }
  return peaks;
}

void expectMode(const ModeRows& modes, std::size_t pixel, const test::Mode& expected) {
  EXPECT_NEAR(modes.step[pixel], expected.step, 1e-3F) << pixel;
  EXPECT_NEAR(modes.score[pixel], expected.score, 1e-3F);
  EXPECT_NEAR(modes.support[pixel], expected.support, 1e-3F);
  EXPECT_NEAR(modes.second[pixel], expected.second, 1e-3F);
  EXPECT_EQ(modes.voters[pixel], expected.voters);
  EXPECT_NEAR(modes.spread2[pixel], expected.spread2, 2e-3F);
}

// All modes of all pixels but a few: of two peaks with the same count rounding chooses.
void expectThoseOfOnePixel(const std::vector<ModeRows>& modes, const Voters& voters) {
  std::size_t ties = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    std::vector<test::Mode> expected = test::modesOf(peaksOf(voters, i), kSigma, modes.size());
    expected.resize(modes.size());
    for (std::size_t k = 0; k < modes.size(); ++k) {
      if (std::abs(expected[k].step - modes[k].step[i]) > 0.5F && ++ties <= 2) break;
      expectMode(modes[k], i, expected[k]);
    }
  }
}

TEST(VoteKernels, AgreeWithTheVotesOfOnePixel) {
  const Voters voters = randomVoters(1);
  test::forEachTarget([&] { expectThoseOfOnePixel(counted(voters), voters); });
}

TEST(VoteKernels, AVoterWithSeveralPeaksVotesOnce) {
  const Voters voters = randomVoters(2, 3);
  test::forEachTarget([&] { expectThoseOfOnePixel(counted(voters, 3), voters); });
}

TEST(VoteKernels, APixelDoesNotDependOnThoseBesideIt) {
  const Voters voters = randomVoters(3, 2);
  const ModeRows all = counted(voters)[0];
  constexpr std::size_t kMoved = 3;
  Voters others = randomVoters(4, 2);
  for (std::size_t j = 0; j < voters.rows.size(); ++j) {
    for (std::size_t i = 0; i + kMoved < kPixels; i += 7) {
      others.rows[j].step[i + kMoved] = voters.rows[j].step[i];
      others.rows[j].score[i + kMoved] = voters.rows[j].score[i];
      others.rows[j].curvature[i + kMoved] = voters.rows[j].curvature[i];
    }
  }
  const ModeRows modes = counted(others)[0];
  for (std::size_t i = 0; i + kMoved < kPixels; i += 7) {
    EXPECT_EQ(modes.step[i + kMoved], all.step[i]);
    EXPECT_EQ(modes.score[i + kMoved], all.score[i]);
    EXPECT_EQ(modes.support[i + kMoved], all.support[i]);
    EXPECT_EQ(modes.second[i + kMoved], all.second[i]);
    EXPECT_EQ(modes.spread2[i + kMoved], all.spread2[i]);
  }
}

TEST(VoteKernels, WhereNobodyVotesThereIsNothing) {
  Voters voters = randomVoters(5);
  for (Rows& rows : voters.rows) std::fill(rows.score.begin(), rows.score.begin() + 20, kNoPeak);
  const ModeRows modes = counted(voters)[0];
  for (std::size_t i = 0; i < 20; ++i) expectMode(modes, i, {});
  EXPECT_GT(modes.score[20] + modes.support[20], 0);
}

}  // namespace
}  // namespace vdbfuse::stereo
