// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/reliability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "fusion/pixel_testimony.h"
#include "fusion/scenes.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

enum class Confidence { None, High, Low, Noise };

// A noisy sphere of which 12 % of the pixels are replaced by depths in [near, far].
struct Planted {
  std::vector<View> views = test::sphereViews(24);
  std::vector<Image<std::uint8_t>> is_outlier;
  SensorModel sensor = test::sphereSensor(0.004);

  explicit Planted(Confidence kind, double share = 0.12) {
    test::addNoise(views, {0.004, 0, 0}, 9);
    for (std::size_t i = 0; i < views.size(); ++i) {
      Random random(11, i);
      DepthMap& map = views[i].map;
      is_outlier.emplace_back(64, 64);
      if (kind != Confidence::None) map.confidence = Image<float>(64, 64);
      for (std::size_t p = 0; p < map.depth.size(); ++p) {
        float& d = map.depth.data()[p];
        const float truth = d;
        bool bad = d != kInvalidDepth && random.uniform() < share;
        if (bad) d = static_cast<float>(random.uniform(1.4, 2.6));
        // A mistake within 3 combined standard deviations of two views is none.
        const double noise = lookupNoise(sensor, views[i].projection, truth);
        bad = bad && std::abs(d - truth) > 3 * std::numbers::sqrt2 * noise;
        is_outlier.back().data()[p] = bad;
        if (kind == Confidence::None) continue;
        const double quality = kind == Confidence::Noise  ? 0
                               : kind == Confidence::High ? (bad ? -1 : 1)
                                                          : (bad ? 1 : -1);
        map.confidence.data()[p] = static_cast<float>(quality + random.normal());
      }
    }
  }

  Judgement judged(const JudgeOptions& options = {}) const {
    return judge(views, sensor, ViewGraph(test::headersOf(views), 1.7), options);
  }

  // Shares of planted outliers that are found, and of inliers that are lost.
  std::pair<double, double> foundAndLost(const Judgement& judgement) const {
    double bad = 0, found = 0, good = 0, lost = 0;
    for (std::size_t i = 0; i < views.size(); ++i)
      for (std::size_t p = 0; p < is_outlier[i].size(); ++p) {
        if (views[i].map.depth.data()[p] == kInvalidDepth) continue;
        const bool doubted = judgement.judged.views[i].outlier.data()[p] > 0.5f;
        (is_outlier[i].data()[p] ? bad : good) += 1;
        (is_outlier[i].data()[p] ? found : lost) += doubted;
      }
    return {found / bad, lost / good};
  }
};

class EveryConfidence : public testing::TestWithParam<std::pair<Confidence, ConfidenceDirection>> {};
INSTANTIATE_TEST_SUITE_P(Confidences, EveryConfidence,
                         testing::Values(std::pair{Confidence::None, ConfidenceDirection::None},
                                         std::pair{Confidence::High, ConfidenceDirection::HighIsGood},
                                         std::pair{Confidence::Low, ConfidenceDirection::HighIsBad},
                                         std::pair{Confidence::Noise, ConfidenceDirection::Uninformative}));

TEST_P(EveryConfidence, PlantedOutliersAreFoundAndInliersKept) {
  const Planted planted(GetParam().first);
  const Judgement judgement = planted.judged();
  const auto [found, lost] = planted.foundAndLost(judgement);
  EXPECT_GT(found, 0.9);
  EXPECT_LT(lost, 0.05);
  EXPECT_NEAR(judgement.model.outlier_share, 0.12, 0.04);
  EXPECT_EQ(confidenceDirection(judgement.model), GetParam().second);
}

TEST(Judge, AnInformativeConfidenceFindsMore) {
  const Planted without(Confidence::None), with(Confidence::High);
  const auto [found_without, lost_without] = without.foundAndLost(without.judged());
  const auto [found, lost] = with.foundAndLost(with.judged());
  EXPECT_LE((1 - found) + lost, (1 - found_without) + lost_without + 0.01);
}

TEST(Judge, ProbabilitiesStayWithinTheirBoundsAndMissingPixelsAreNotBelieved) {
  const Planted planted(Confidence::High);
  const Judgement judgement = planted.judged();
  for (const JudgedView& view : judgement.judged.views)
    for (std::size_t p = 0; p < view.depth.size(); ++p) {
      ASSERT_GE(view.outlier.data()[p], kMinOutlier);
      ASSERT_LE(view.outlier.data()[p], kMaxOutlier);
      if (view.depth.data()[p] == kInvalidDepth) {
        ASSERT_EQ(view.outlier.data()[p], kMaxOutlier);
      }
    }
}

TEST(Judge, UnknownAndConstantConfidencesAreNoTrouble) {
  Planted planted(Confidence::High);
  for (View& view : planted.views) view.map.confidence(5, 5) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_GT(planted.foundAndLost(planted.judged()).first, 0.9);
  for (View& view : planted.views) view.map.confidence = Image<float>(64, 64, 1.0f);
  const Judgement constant = planted.judged();
  EXPECT_EQ(confidenceDirection(constant.model), ConfidenceDirection::None);
  EXPECT_GT(planted.foundAndLost(constant).first, 0.9);
}

TEST(Judge, CleanViewsAreBelievedExceptAtTheRim) {
  const Planted planted(Confidence::None, 0.0);
  const Judgement judgement = planted.judged();
  double lost = 0, all = 0;
  for (const JudgedView& view : judgement.judged.views)
    for (std::size_t p = 0; p < view.depth.size(); ++p)
      if (view.incidence.data()[p] > 0.5f) lost += view.outlier.data()[p] > 0.5f, ++all;
  EXPECT_LT(lost / all, 0.02);
  EXPECT_LT(judgement.model.outlier_share, 0.15);
}

TEST(Judge, NoReturnsMeanEmptySpaceAroundAnObjectUnlessToldOtherwise) {
  const Planted planted(Confidence::None, 0.0);
  const auto marked = [&](JudgeOptions::NoReturn rule) {
    JudgeOptions options;
    options.no_return = rule;
    const Judgement judgement = planted.judged(options);
    const Image<Look>& look = judgement.judged.views[0].look;
    EXPECT_EQ(look(32, 32), Look::Nothing);
    return std::count(look.begin(), look.end(), Look::Empty);
  };
  EXPECT_EQ(marked(JudgeOptions::NoReturn::Ignore), 0);
  EXPECT_GT(marked(JudgeOptions::NoReturn::Free), 100);
}

TEST(Judge, AMaskSaysWhereTheObjectIsAndWhatIsMissingInsideItIsAHole) {
  Planted planted(Confidence::None, 0.0);
  // A dark patch that reaches the silhouette.
  for (View& view : planted.views) {
    DepthMap& map = view.map;
    map.mask = Image<std::uint8_t>(64, 64);
    std::transform(map.depth.begin(), map.depth.end(), map.mask.begin(),
                   [](float d) -> std::uint8_t { return d != kInvalidDepth ? 255 : 0; });
    for (int y = 26; y < 38; ++y)
      for (int x = 0; x < 32; ++x) map.depth(x, y) = kInvalidDepth;
  }
  const Judgement masked = planted.judged();
  for (const JudgedView& view : masked.judged.views)
    for (std::size_t p = 0; p < view.look.size(); ++p) {
      const bool object = planted.views.front().map.mask.data()[p] != 0;
      ASSERT_EQ(view.look.data()[p], object ? Look::Nothing : Look::Outside);
    }
  for (View& view : planted.views) view.map.mask = {};
  // Without a mask the others do, who see what lies there.
  EXPECT_EQ(planted.judged().judged.views[0].look(10, 32), Look::Nothing);
  JudgeOptions options;
  options.no_return = JudgeOptions::NoReturn::Free;  // whoever says so is believed
  EXPECT_EQ(planted.judged(options).judged.views[0].look(10, 32), Look::Empty);
}

TEST(Judge, ADepthOutsideTheMaskIsBackground) {
  Planted planted(Confidence::None, 0.0);
  for (View& view : planted.views) {
    view.map.mask = Image<std::uint8_t>(64, 64, 1);
    for (int x = 0; x < 64; ++x) view.map.mask(x, 30) = 0;
  }
  const JudgedView view = planted.judged().judged.views[1];
  EXPECT_EQ(view.depth(32, 30), kInvalidDepth);
  EXPECT_EQ(view.look(32, 30), Look::Outside);
  EXPECT_EQ(view.depth(32, 31), planted.views[1].map.depth(32, 31));
  EXPECT_EQ(view.look(32, 31), Look::Nothing);
}

TEST(Judge, NeighboursContradictAPointOutsideTheirMasks) {
  std::vector<View> views = test::sphereViews(24);
  std::vector<CompactSurface> surfaces;
  for (const View& view : views) surfaces.push_back(analyseCompactly(view, test::sphereSensor().noise));
  std::vector<std::size_t> order(views.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto neighbours = chooseNeighbours(ViewGraph(test::headersOf(views), 1.7), views.size());
  const auto hear = [&] {
    return hearNeighbours(views, surfaces, test::sphereSensor(), neighbours, {}, order, {}).views[0](32, 32);
  };
  EXPECT_EQ(hear().contradiction, 0);
  EXPECT_GT(hear().agreement, 0);
  for (std::size_t i = 1; i < views.size(); ++i) views[i].map.mask = Image<std::uint8_t>(64, 64);
  EXPECT_EQ(hear().contradiction, 2);
  EXPECT_EQ(hear().agreement, 0);
}

TEST(Judge, TheMissRateGrowsByWhatIsMissing) {
  Planted planted(Confidence::None, 0.0);
  // Not zero: beside the rim a confirmed point is looked for where there is nothing any more.
  const double complete = planted.judged().judged.miss_rate;
  EXPECT_LT(complete, 0.2);
  Random random(5);
  for (View& view : planted.views)
    for (float& d : view.map.depth)
      if (random.uniform() < 0.3) d = kInvalidDepth;
  EXPECT_NEAR(planted.judged().judged.miss_rate, complete + 0.3 * (1 - complete), 0.1);
}

TEST(Judge, IsTheSameForOneAndTwoThreads) {
  const Planted planted(Confidence::High);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return planted.judged().judged.views[7].outlier;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(Judge, OneViewAloneIsJudgedByItsContinuity) {
  std::vector<View> views = {test::sphereViews(1).front()};
  const ViewGraph graph(test::headersOf(views), 1.7);
  const Judgement judgement = judge(views, test::sphereSensor(), graph);
  EXPECT_EQ(judgement.judged.views.size(), 1u);
  EXPECT_EQ(judgement.judged.miss_rate, 0.5);
}

}  // namespace
}  // namespace vdbfuse
