// SPDX-License-Identifier: Apache-2.0
#include "fusion/block_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fusion/scenes.h"
#include "vdbfuse/fusion/likelihood.h"

namespace vdbfuse {
namespace {

std::vector<Eigen::Vector3d> randomPoints(std::size_t count, const Eigen::Vector3d& centre, double reach) {
  std::vector<Eigen::Vector3d> points;
  Random random(9);
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(centre + Eigen::Vector3d(random.uniform(-reach, reach), random.uniform(-reach, reach),
                                              random.uniform(-reach, reach)));
  }
  return points;
}

struct OneView {
  explicit OneView(const Projection& projection = test::cameraFor(64, 0.5, 2.0)) {
    std::vector<View> views = test::sphereViews(1);
    test::addNoise(views, {0.01, 0, 0}, 3);
    views.front().projection = projection;
    judged = believe(std::move(views), test::sphereSensor());
    Random random(5);
    for (float& outlier : judged.views.front().outlier)
      outlier = static_cast<float>(random.uniform(0.003, 0.9));
  }
  JudgedViews judged;
};

class EveryProjection : public testing::TestWithParam<int> {
 protected:
  static Projection projection() {
    const Pinhole plain = test::cameraFor(64, 0.5, 2.0);
    if (GetParam() == 0) return plain;
    Pinhole bent = plain;
    bent.distortion[0] = -0.1;
    return bent;
  }
};

TEST_P(EveryProjection, LookingAtABlockIsLookingAtEachPoint) {
  const OneView scene(projection());
  const PreparedView view = PreparedView(scene.judged.views.front(), scene.judged.sensor);
  for (const std::size_t count : {512u, 511u, 3u, 1u}) {
    const auto points = randomPoints(count, Eigen::Vector3d::Zero(), 1.2);
    const BlockLook seen = look(view, PointBlock(points));
    std::size_t in_sight = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto expected = view.projector(points[i]);
      ASSERT_EQ(seen.pixel[i] >= 0, expected.has_value()) << i;
      if (!expected) continue;
      ++in_sight;
      EXPECT_EQ(seen.pixel[i], expected->y * 64 + expected->x) << i;
      EXPECT_NEAR(seen.depth[i], expected->depth, 1e-5) << i;
    }
    EXPECT_GE(in_sight, count / 10);
  }
}

TEST_P(EveryProjection, FarFromTheOriginNothingIsLost) {
  OneView scene(projection());
  const Eigen::Vector3d shift(4e5, -5e6, 120);
  scene.judged.views.front().world_from_camera.pretranslate(shift);
  const PreparedView view = PreparedView(scene.judged.views.front(), scene.judged.sensor);
  const auto points = randomPoints(512, shift, 0.5);
  const BlockLook seen = look(view, PointBlock(points));
  for (std::size_t i = 0; i < 512; ++i) {
    const auto expected = view.projector(points[i]);
    ASSERT_EQ(seen.pixel[i] >= 0, expected.has_value()) << i;
    if (!expected) continue;
    EXPECT_NEAR(seen.depth[i], expected->depth, 2e-5) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(BlockKernels, EveryProjection, testing::Values(0, 1));

TEST(BlockKernels, TheTestimonyOfABlockIsTheExactRatioOfEachPoint) {
  for (const NoiseShape& shape : {gaussianNoise(), logisticNoise(), laplaceNoise()}) {
    OneView scene;
    scene.judged.sensor.shape = shape;
    const PreparedView view = PreparedView(scene.judged.views.front(), scene.judged.sensor);
    const LikelihoodRatio ratio(scene.judged.sensor);
    const auto points = randomPoints(500, Eigen::Vector3d::Zero(), 0.55);
    const BlockLook seen = look(view, PointBlock(points));
    const BlockTestimony said = testify(view, ratio, 0.0f, seen, points.size());
    std::size_t measured = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float depth = seen.pixel[i] < 0 ? 0 : view.view->depth.data()[seen.pixel[i]];
      ASSERT_EQ(said.share[i], depth == kInvalidDepth ? 0.0f : 1.0f);
      if (depth == kInvalidDepth) continue;
      ++measured;
      const Measurement m(depth, view.noise.at(depth), view.view->outlier.data()[seen.pixel[i]]);
      EXPECT_NEAR(said.log_ratio[i], logLikelihoodRatio(scene.judged.sensor, m, seen.depth[i]), 2e-3) << i;
    }
    EXPECT_GT(measured, 200u);
  }
}

TEST(BlockKernels, ComparingABlockIsComparingEachPoint) {
  constexpr float kSigmas = 3.0f;
  for (const double far : {4.0, std::numeric_limits<double>::infinity()}) {
    OneView scene;
    JudgedView& view = scene.judged.views.front();
    for (std::size_t p = 0; p < view.depth.size(); p += 7) view.depth.data()[p] = kInvalidDepth;
    scene.judged.sensor.far = far;
    const LookupVariance variance(scene.judged.sensor, view.projection);
    const auto points = randomPoints(500, Eigen::Vector3d::Zero(), 0.8);
    std::vector<float> own(PointBlock::kCapacity);
    Random random(11);
    for (float& n : own) n = static_cast<float>(random.uniform(0.0, 0.2));
    const BlockLook seen = look(Projector(view.projection, view.world_from_camera), PointBlock(points));
    const BlockComparison found =
        compare(view.depth.data(), variance, kSigmas, own.data(), seen, points.size());
    std::map<Measured, int> counts;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ++counts[found[i]];
      if (seen.pixel[i] < 0) {
        EXPECT_EQ(found[i], Measured::Unseen) << i;
        continue;
      }
      const float measured = view.depth.data()[seen.pixel[i]], further = measured - seen.depth[i];
      if (measured == kInvalidDepth) {
        EXPECT_EQ(found[i], Measured::Nothing) << i;
        continue;
      }
      const double noise = lookupNoise(scene.judged.sensor, view.projection, measured);
      const auto limit = static_cast<float>(kSigmas * std::hypot(own[i], noise));
      if (std::abs(std::abs(further) - limit) < 1e-5f) continue;  // either
      EXPECT_EQ(found[i], std::abs(further) < limit ? Measured::Same
                          : further > 0             ? Measured::Further
                                                    : Measured::Nearer)
          << i;
    }
    EXPECT_EQ(counts.size(), 5u);  // each was seen
  }
}

// What one view answers about random points with random normals, some unknown.
struct Asked {
  Asked() : points(randomPoints(500, Eigen::Vector3d(5, 0, 0), 0.8)), image(40) {
    Random random(13);
    const auto anyNormal = [&] {
      const Eigen::Vector3f n(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                              static_cast<float>(random.normal()));
      return random.uniform() < 0.2 ? PackedNormal() : PackedNormal(n.normalized());
    };
    std::generate(image.begin(), image.end(), anyNormal);
    for (std::size_t i = 0; i < points.size(); ++i) {
      normals[i] = anyNormal();
      said.words[i] = static_cast<std::int32_t>(random.uniform(0, 5));
      seen.pixel[i] = said[i] == Measured::Unseen ? -1 : static_cast<std::int32_t>(random.uniform(0, 40));
    }
  }

  std::vector<Eigen::Vector3d> points;
  std::vector<PackedNormal> image;
  BlockNormals normals;
  BlockComparison said;
  BlockLook seen;
};

TEST(BlockKernels, ASurfaceThatIsTurnedAwayIsAnother) {
  const Asked asked;
  BlockComparison told = asked.said;
  tellSidesApart(asked.normals, asked.image.data(), asked.seen, asked.points.size(), told);
  int turned = 0, kept = 0;
  for (std::size_t i = 0; i < asked.points.size(); ++i) {
    if (asked.said[i] != Measured::Same) {
      EXPECT_EQ(told[i], asked.said[i]) << i;
      continue;
    }
    const PackedNormal own = asked.normals[i],
                       other = asked.image[static_cast<std::size_t>(asked.seen.pixel[i])];
    const float cosine = own.unpack().dot(other.unpack());
    const bool turns = !own.isNone() && !other.isNone() && cosine < std::sqrt(0.5f);
    if (std::abs(cosine - std::sqrt(0.5f)) > 1e-3f) {
      EXPECT_EQ(told[i], turns ? Measured::Nearer : Measured::Same) << i;
    }
    ++(turns ? turned : kept);
  }
  EXPECT_GT(std::min(turned, kept), 10);
}

TEST(BlockKernels, AnswersAreCountedAndWhoIsHiddenMustFaceTheSensor) {
  const Asked asked;
  const PointBlock block(asked.points);
  const Eigen::Vector3d sensor(5, 1, 0);  // among the points
  BlockAnswers answers;
  count(asked.said, asked.normals, sensor, block, answers);
  count(asked.said, asked.normals, sensor, block, answers);
  int faced = 0, averted = 0;
  for (std::size_t i = 0; i < asked.points.size(); ++i) {
    EXPECT_EQ(answers.agreeing[i], asked.said[i] == Measured::Same ? 2 : 0) << i;
    EXPECT_EQ(answers.past[i], asked.said[i] == Measured::Further ? 2 : 0) << i;
    EXPECT_EQ(answers.missed[i], asked.said[i] == Measured::Nothing ? 2 : 0) << i;
    const Eigen::Vector3f ray = (sensor - asked.points[i]).normalized().cast<float>();
    const float cosine = asked.normals[i].unpack().dot(ray);
    const bool faces = asked.normals[i].isNone() || cosine > 0.26f;
    const bool is_hidden = asked.said[i] == Measured::Nearer;
    if (std::abs(cosine - 0.26f) > 1e-3f) {
      EXPECT_EQ(answers.hidden[i], is_hidden && faces ? 2 : 0) << i;
    }
    if (is_hidden) ++(faces ? faced : averted);
  }
  EXPECT_GT(std::min(faced, averted), 10);
}

// Points that are all on the same side take a shorter way.
TEST(BlockKernels, FarFromTheSurfaceTheTestimonyIsTheExactRatioToo) {
  for (const NoiseShape& shape : {gaussianNoise(), logisticNoise(), laplaceNoise()}) {
    for (const double shift : {0.0, 1.0}) {
      OneView scene;
      scene.judged.sensor.shape = shape;
      scene.judged.sensor.near = 0.5;
      const PreparedView view = PreparedView(scene.judged.views.front(), scene.judged.sensor);
      const LikelihoodRatio ratio(scene.judged.sensor);
      const Eigen::Vector3d towards = scene.judged.views.front().world_from_camera.translation().normalized();
      const auto points = randomPoints(500, 0.8 * shift * towards, 0.2);
      const BlockLook seen = look(view, PointBlock(points));
      const BlockTestimony said = testify(view, ratio, 0.0f, seen, points.size());
      std::size_t measured = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (said.share[i] == 0) continue;
        ++measured;
        const float depth = view.view->depth.data()[seen.pixel[i]];
        const Measurement m(depth, view.noise.at(depth), view.view->outlier.data()[seen.pixel[i]]);
        EXPECT_NEAR(said.log_ratio[i], logLikelihoodRatio(scene.judged.sensor, m, seen.depth[i]), 2e-3) << i;
      }
      EXPECT_GT(measured, 200u);
    }
  }
}

TEST(BlockKernels, AViewCountsForLessBehindWhatItMeasured) {
  constexpr float kThickness = 0.1f;
  for (const bool several : {false, true}) {
    OneView scene;
    JudgedView& judged = scene.judged.views.front();
    if (several) judged.alternatives.push_back({Image<float>(64, 64), Image<float>(64, 64)});
    const PreparedView view = PreparedView(scene.judged.views.front(), scene.judged.sensor);
    const LikelihoodRatio ratio(scene.judged.sensor);
    const auto points = randomPoints(500, Eigen::Vector3d::Zero(), 0.55);
    const BlockLook seen = look(view, PointBlock(points));
    const BlockTestimony said = testify(view, ratio, kThickness, seen, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float depth = seen.pixel[i] < 0 ? 0 : judged.depth.data()[seen.pixel[i]];
      if (depth == kInvalidDepth) {
        ASSERT_EQ(said.share[i], 0.0f);
        continue;
      }
      const double behind = std::max(0.0f, (seen.depth[i] - depth) / kThickness);
      ASSERT_NEAR(said.share[i], std::exp(-behind * behind), 1e-5) << several;
    }
  }
}

TEST(BlockKernels, AnAlternativeDepthIsHeard) {
  OneView scene;
  JudgedView& judged = scene.judged.views.front();
  judged.outlier = Image<float>(64, 64, 0.01f);
  judged.alternatives.push_back({Image<float>(64, 64, 2.4f), Image<float>(64, 64, 0.4f)});
  const PreparedView view = PreparedView(scene.judged.views.front(), scene.judged.sensor);
  const LikelihoodRatio ratio(scene.judged.sensor);
  const auto points = randomPoints(300, Eigen::Vector3d::Zero(), 0.4);
  const BlockLook seen = look(view, PointBlock(points));
  const BlockTestimony said = testify(view, ratio, 0.0f, seen, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (said.share[i] == 0) continue;
    const float depth = view.view->depth.data()[seen.pixel[i]];
    Measurement m(depth, view.noise.at(depth), 0.01);
    m.hypotheses[0].share = 0.6;
    m.hypotheses[1] = {2.4f, view.noise.at(2.4f), 0.4};
    m.count = 2;
    EXPECT_NEAR(said.log_ratio[i], logLikelihoodRatio(scene.judged.sensor, m, seen.depth[i]), 2e-3) << i;
  }
}

TEST(BlockKernels, AccumulatingIsAddingEachAndTakingAwayIsTheReverse) {
  const VisibilityIntegral integral(0.5, 0.0, 30);
  BlockTestimony said;
  Random random(2);
  for (std::size_t i = 0; i < 512; ++i) {
    said.log_ratio[i] = static_cast<float>(random.uniform(-8, 8));
    said.share[i] = i % 3 == 0 ? 0.0f : i % 3 == 1 ? 0.4f : 1.0f;
  }
  const std::size_t nodes = static_cast<std::size_t>(integral.nodeCount());
  std::vector<float> sums(512 * nodes, 0.0f), expected(512 * nodes, 0.0f);
  accumulate(integral, said, 0.7f, 512, sums.data());
  for (std::size_t i = 0; i < 512; ++i)
    if (said.share[i] != 0) integral.add(said.log_ratio[i], 0.7f * said.share[i], &expected[i * nodes]);
  for (std::size_t k = 0; k < sums.size(); ++k) ASSERT_NEAR(sums[k], expected[k], 1e-5);
  accumulate(integral, said, -0.7f, 512, sums.data());
  for (const float left : sums) ASSERT_NEAR(left, 0.0f, 1e-6f);
}

}  // namespace
}  // namespace vdbfuse
