// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/running_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fusion/scenes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

const GridFrame kFrame{0.05};

std::vector<Index3> leaves() {
  std::vector<Index3> origins;
  for (int x = -16; x < 16; x += 8)
    for (int y = -16; y < 16; y += 8)
      for (int z = -16; z < 16; z += 8) origins.emplace_back(x, y, z);
  return origins;
}

JudgedViews noisySphere(int count) {
  std::vector<View> views = test::sphereViews(count);
  test::addNoise(views, {0.005, 0, 0}, 7);
  return believe(std::move(views), test::sphereSensor(), 0.05);
}

double largestDifference(const ScalarGrid& a, const ScalarGrid& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.leafCount(); ++i) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const double x = a.leaf(i).values[static_cast<std::size_t>(k)],
                   y = b.leaf(i).values[static_cast<std::size_t>(k)];
      largest = std::max(largest, std::abs(x - y) / (1 + std::abs(x)));
    }
  }
  return largest;
}

class EveryRunningRule : public testing::TestWithParam<EvidenceRule> {
 protected:
  static RunningEvidence empty(const JudgedViews& judged) {
    RunningEvidenceOptions options;
    options.evidence.rule = GetParam();
    options.miss_rate = judged.miss_rate;
    return {judged.sensor, kFrame, leaves(), options};
  }
};

TEST_P(EveryRunningRule, IsTheEvidenceOfAllViewsAtOnce) {
  JudgedViews judged = noisySphere(10);
  judged.views[3].weight = 0.4;
  RunningEvidence running = empty(judged);
  for (const JudgedView& view : judged.views) running.add(view);
  const ScalarGrid sigma = running.evidence();
  EvidenceOptions options;
  options.rule = GetParam();
  for (std::size_t i = 0; i < sigma.leafCount(); i += 5) {
    for (int k = 0; k < ScalarGrid::kLeafSize; k += 37) {
      const Index3 voxel = sigma.leaf(i).origin + Index3(k >> 6, k >> 3 & 7, k & 7);
      const float expected = evidenceAt(judged, {kFrame.toWorld(voxel)}, options).front();
      EXPECT_NEAR(sigma.at(voxel), expected, 2e-3 * (1 + std::abs(expected)));
    }
  }
}

TEST_P(EveryRunningRule, AViewThatComesAndGoesLeavesNoTrace) {
  const JudgedViews judged = noisySphere(8);
  RunningEvidence running = empty(judged);
  for (std::size_t i = 0; i < 6; ++i) running.add(judged.views[i]);
  const ScalarGrid before = running.evidence();
  running.add(judged.views[6]), running.add(judged.views[7]);
  EXPECT_GT(largestDifference(before, running.evidence()), 0.1);
  running.remove(judged.views[6]), running.remove(judged.views[7]);
  // Equation (5) takes the logarithm of 1 − Π π, which is small where many views deny.
  const double rounding = GetParam() == EvidenceRule::Paper ? 2e-3 : 1e-4;
  EXPECT_LT(largestDifference(before, running.evidence()), rounding);
}

TEST_P(EveryRunningRule, TheOrderOfTheViewsDoesNotMatter) {
  const JudgedViews judged = noisySphere(8);
  RunningEvidence forwards = empty(judged), backwards = empty(judged);
  for (std::size_t i = 0; i < 8; ++i) forwards.add(judged.views[i]), backwards.add(judged.views[7 - i]);
  EXPECT_LT(largestDifference(forwards.evidence(), backwards.evidence()), 1e-4);
}

TEST_P(EveryRunningRule, IsTheSameForOneThreadAndTwo) {
  const JudgedViews judged = noisySphere(3);
  RunningEvidence many = empty(judged), single = empty(judged);
  for (const JudgedView& view : judged.views) many.add(view);
  const ThreadLimit one(1);
  for (const JudgedView& view : judged.views) single.add(view);
  EXPECT_EQ(largestDifference(many.evidence(), single.evidence()), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Rules, EveryRunningRule,
                         testing::Values(EvidenceRule::Outside, EvidenceRule::Paper,
                                         EvidenceRule::NoSelfOcclusion));

TEST(RunningEvidence, WrongOptionsAreRefused) {
  RunningEvidenceOptions options;
  options.evidence.visibility_prior = -1;
  EXPECT_THROW(RunningEvidence(test::sphereSensor(), kFrame, leaves(), options), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
