// SPDX-License-Identifier: Apache-2.0
// Pixels that offer several depths: which one do the other views confirm?
#include <gtest/gtest.h>

#include "fusion/scenes.h"
#include "vdbfuse/fusion/agreement.h"
#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/fusion/reliability.h"

namespace vdbfuse {
namespace {

// A sphere of which three pixels in ten say something else first, and the truth second.
struct Ambiguous {
  Ambiguous() : truth(test::sphereViews(16)) {
    test::addNoise(truth, {0.003, 0, 0}, 4);
    views = truth;
    for (std::size_t i = 0; i < views.size(); ++i) {
      Random random(11, i);
      DepthMap& map = views[i].map;
      map.alternatives.push_back({Image<float>(64, 64), Image<float>(64, 64)});
      for (std::size_t p = 0; p < map.depth.size(); ++p) {
        if (map.depth.data()[p] == kInvalidDepth || random.uniform() > 0.3) continue;
        map.alternatives[0].depth.data()[p] = map.depth.data()[p];
        map.alternatives[0].share.data()[p] = 0.4f;
        map.depth.data()[p] = static_cast<float>(random.uniform(1.4, 2.6));
      }
    }
  }
  Judgement judged(std::vector<View> some) const {
    std::vector<const ViewHeader*> headers;
    for (const View& view : some) headers.push_back(&view);
    const ViewGraph graph(headers, 1.6);
    return judge(std::move(some), test::sphereSensor(0.004), graph);
  }
  // Share of the object's pixels whose first depth is the true one.
  double right(const JudgedViews& result) const {
    double right = 0, all = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      for (std::size_t p = 0; p < truth[i].map.depth.size(); ++p) {
        if (truth[i].map.depth.data()[p] == kInvalidDepth) continue;
        ++all, right += result.views[i].depth.data()[p] == truth[i].map.depth.data()[p];
      }
    }
    return right / all;
  }
  std::vector<View> truth, views;
};

TEST(Alternatives, TheOneThatOthersConfirmComesFirst) {
  const Ambiguous scene;
  EXPECT_NEAR(scene.right(believe(scene.views, {})), 0.7, 0.02);
  const Judgement judgement = scene.judged(scene.views);
  EXPECT_GT(scene.right(judgement.judged), 0.95);
  ASSERT_EQ(judgement.judged.views.size(), 16u);
  for (const JudgedView& view : judgement.judged.views) {
    ASSERT_EQ(view.alternatives.size(), 1u);
    for (std::size_t p = 0; p < view.depth.size(); ++p) {
      const float share = view.alternatives[0].share.data()[p];
      EXPECT_TRUE(share >= 0 && share <= 1);
    }
  }
}

TEST(Alternatives, TheTruthAmongThemIsWorthNearlyAsMuchAsTheTruthAlone) {
  const Ambiguous scene;
  std::vector<View> without = scene.views;
  for (View& view : without) view.map.alternatives.clear();
  const auto doubt = [&](const std::vector<View>& views) {
    double sum = 0, all = 0;
    const Judgement judgement = scene.judged(views);
    for (const JudgedView& view : judgement.judged.views)
      for (std::size_t p = 0; p < view.depth.size(); ++p)
        if (view.depth.data()[p] != kInvalidDepth) ++all, sum += view.outlier.data()[p];
    return sum / all;
  };
  EXPECT_LT(doubt(scene.views), 0.5 * doubt(without));
}

TEST(Alternatives, AllOfThemCountAsPlacesOfTheSurface) {
  View view = test::sphereViews(1).front();
  view.map.depth = Image<float>(64, 64, 1.8f);
  view.map.alternatives.push_back({Image<float>(64, 64, 2.2f), Image<float>(64, 64, 0.25f)});
  const GridFrame frame{0.05};
  const JudgedViews judged = believe({view}, test::sphereSensor(), 0.003);
  const Box box(Eigen::Vector3d::Constant(-0.6), Eigen::Vector3d::Constant(0.6));
  const ScalarGrid support = countAgreement(judged, frame, box);
  const Eigen::Vector3d axis = view.world_from_camera.linear().col(2),
                        eye = view.world_from_camera.translation();
  const auto at = [&](double depth) {
    return support.at((frame.toIndex(eye + depth * axis)).array().round().matrix().cast<int>());
  };
  EXPECT_GT(at(1.8), 0.3f);
  EXPECT_GT(at(2.2), 0.1f);
  EXPECT_LT(at(2.2), at(1.8));
  EXPECT_LT(at(2.0), 0.01f);
}

TEST(Alternatives, WithoutAnyNothingChanges) {
  const Ambiguous scene;
  std::vector<View> empty_layers = scene.truth;
  for (View& view : empty_layers)
    view.map.alternatives.push_back({Image<float>(64, 64), Image<float>(64, 64)});
  const Judgement plain = scene.judged(scene.truth), with = scene.judged(empty_layers);
  for (std::size_t i = 0; i < plain.judged.views.size(); ++i) {
    for (std::size_t p = 0; p < plain.judged.views[i].outlier.size(); ++p)
      ASSERT_NEAR(plain.judged.views[i].outlier.data()[p], with.judged.views[i].outlier.data()[p], 1e-6);
  }
}

}  // namespace
}  // namespace vdbfuse
