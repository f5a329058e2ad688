// SPDX-License-Identifier: Apache-2.0
#include "fusion/learn_reliability.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

// Pixels of which the same was observed.
struct Crowd {
  int count;
  unsigned agreement, contradiction, occlusion, continuity;
};

PixelTestimony testimonyOf(const Crowd& crowd) {
  PixelTestimony t;
  t.measured = true;
  t.agreement = crowd.agreement & 7u, t.contradiction = crowd.contradiction & 3u;
  t.occlusion = crowd.occlusion & 3u, t.continuity = crowd.continuity & 3u;
  return t;
}

ReliabilityTable learn(const std::vector<Crowd>& crowds) {
  Testimonies testimonies;
  testimonies.miss_rate = 0.5;
  for (const Crowd& crowd : crowds) {
    testimonies.views.emplace_back(crowd.count, 1);
    for (PixelTestimony& t : testimonies.views.back()) t = testimonyOf(crowd);
  }
  return learnReliability(testimonies, std::vector<Image<std::uint8_t>>(crowds.size()));
}

// Most pixels are confirmed, some are contradicted, of two kinds of continuity.
const std::vector<Crowd> kScan = {
    {100000, 3, 0, 0, 3}, {1000, 3, 0, 0, 1}, {5000, 0, 2, 0, 0}, {100, 0, 2, 0, 1}};
const Crowd kDoubtful{100, 0, 0, 2, 1};  // hidden, in a place where many are wrong

TEST(LearnReliability, WhoIsContradictedIsWrongAndWhoIsConfirmedRight) {
  const ReliabilityTable table = learn(kScan);
  for (const Crowd& crowd : kScan) {
    const float outlier = table.outlier(0, testimonyOf(crowd));
    if (crowd.agreement > 0) {
      EXPECT_LT(outlier, 0.05f);
    } else {
      EXPECT_GT(outlier, 0.8f);
    }
  }
}

TEST(LearnReliability, HiddenPixelsAreAcquittedWhereMostOfThemLieOnGoodSurfaces) {
  std::vector<Crowd> few = kScan, many = kScan;
  few.push_back(kDoubtful), many.push_back(kDoubtful);
  many.push_back({3000, 0, 0, 2, 3});  // hidden as well: the bottom of a hollow
  const float suspected = learn(few).outlier(0, testimonyOf(kDoubtful)),
              acquitted = learn(many).outlier(0, testimonyOf(kDoubtful));
  EXPECT_GT(suspected, 0.5f);
  EXPECT_LT(acquitted, 0.2f);
}

TEST(LearnReliability, OnACleanScanTheHiddenAreNotCondemnedForBeingTheOnlySuspects) {
  const Crowd hollow{600, 0, 0, 3, 2};
  const std::vector<Crowd> clean = {{100000, 3, 0, 0, 3}, {20000, 3, 0, 0, 2}, hollow};
  EXPECT_LT(learn(clean).outlier(0, testimonyOf(hollow)), 0.001f);  // 0.02 if it could condemn, too
}

}  // namespace
}  // namespace vdbfuse
