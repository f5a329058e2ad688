// SPDX-License-Identifier: Apache-2.0
#include "stereo/paper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "stereo/paper_ray.h"
#include "stereo/textured_planes.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::stereo {
namespace {

using Score = PaperOptions::Score;
using test::Rectangles;

constexpr int kCameras = 5, kReference = 2;
constexpr int kRadius = 3;
const DepthInterval kDepths{1.5, 2.7};
const Rectangles kFrontal{{.origin = {0, 0, 0.1}, .half_u = 3, .half_v = 3}};
// A strip in front of a wall: beside it two of the four partners see the strip and not the wall.
const Rectangles kOccluded{{.origin = {0, 0, 0.5}, .half_u = 3, .half_v = 3},
                           {.origin = {0, 0, -0.3}, .half_u = 0.12, .half_v = 3, .seed = 2}};

// The reference in the middle of an arc, its partners, and the true depth of all.
struct Scene {
  Photograph reference;
  std::vector<Photograph> partners;
  Image<float> truth;
  std::vector<Image<float>> partner_truths;
  paper::RaySteps steps() const {
    return paper::raySteps(reference, {partners.begin(), partners.end()}, kDepths, kPaperStep);
  }
};

Scene sceneOf(const Rectangles& rectangles, const std::array<double, kCameras>& gains = {1, 1, 1, 1, 1},
              const std::array<double, kCameras>& biases = {}) {
  Scene scene;
  const std::vector<PhotographHeader> cameras = test::camerasOnArc(kCameras, 10);
  for (std::size_t i = 0; i < kCameras; ++i) {
    Photograph photograph = photographOf(rectangles, cameras[i], gains[i], biases[i]);
    Image<float> truth = trueDepthOf(rectangles, cameras[i]);
    if (i == kReference) {
      scene.reference = std::move(photograph), scene.truth = std::move(truth);
    } else {
      scene.partners.push_back(std::move(photograph)), scene.partner_truths.push_back(std::move(truth));
    }
  }
  return scene;
}

template <class T>
Image<T> cut(const Image<T>& image, int x0, int y0, int width, int height) {
  Image<T> result(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) result(x, y) = image(x0 + x, y0 + y);
  return result;
}

// The middle of the reference, where there is some of everything, for tests that need no more.
Scene middleOf(Scene scene) {
  constexpr int kX = 22, kY = 24, kWidth = 40, kHeight = 20;
  Photograph& reference = scene.reference;
  reference.camera.cx -= kX, reference.camera.cy -= kY;
  reference.camera.width = kWidth, reference.camera.height = kHeight;
  reference.brightness = cut(reference.brightness, kX, kY, kWidth, kHeight);
  scene.truth = cut(scene.truth, kX, kY, kWidth, kHeight);
  return scene;
}

StereoView match(const Scene& scene, const PaperOptions& options = {}) {
  return paperDepthMap(scene.reference, scene.partners, kDepths, options);
}

int distanceToRim(const Image<float>& image, int x, int y) {
  return std::min({x, y, image.width() - 1 - x, image.height() - 1 - y});
}

// Whether the whole window sees one surface.
bool isSmooth(const Scene& scene, int x, int y) {
  for (int v = -kRadius; v <= kRadius; ++v)
    for (int u = -kRadius; u <= kRadius; ++u)
      if (std::abs(scene.truth(x + u, y + v) - scene.truth(x, y)) > 0.2) return false;
  return true;
}

int partnersThatSee(const Scene& scene, int x, int y) {
  const Eigen::Vector3d point =
      scene.reference.world_from_camera * unproject(scene.reference.camera, x, y, double{scene.truth(x, y)});
  int count = 0;
  for (std::size_t j = 0; j < scene.partners.size(); ++j) {
    const Photograph& partner = scene.partners[j];
    const auto seen = project(partner.camera, partner.world_from_camera.inverse() * point);
    const int u = nearestPixel(seen->x), v = nearestPixel(seen->y);
    const Image<float>& truth = scene.partner_truths[j];
    count += truth.contains(u, v) && std::abs(double{truth(u, v)} - seen->depth) < 0.1 ? 1 : 0;
  }
  return count;
}

double errorInSteps(const Scene& scene, const StereoView& result, int x, int y) {
  return std::abs(1 / double{result.view.map.depth(x, y)} - 1 / double{scene.truth(x, y)}) /
         scene.steps().step;
}

// Of the wall's pixels that exactly two partners see, those within half a step of the truth.
double shareRightOfHalfOccluded(const Scene& scene, const StereoView& result) {
  double pixels = 0, right = 0;
  for (int y = kRadius; y < scene.truth.height() - kRadius; ++y)
    for (int x = kRadius; x < scene.truth.width() - kRadius; ++x) {
      if (!isSmooth(scene, x, y) || partnersThatSee(scene, x, y) != 2) continue;
      ++pixels;
      right += errorInSteps(scene, result, x, y) < 0.5 ? 1 : 0;
    }
  return right / pixels;
}

TEST(PaperRay, APixelsPointIsSeenWhereThePartnersCameraProjectsIt) {
  const Scene scene = sceneOf(kFrontal);
  const paper::RayImage ray = paper::rayImage(scene.reference, scene.partners[0]);
  for (const double depth : {0.7, 2.0, 40.0}) {
    const Eigen::Vector3d point = scene.partners[0].world_from_camera.inverse() *
                                  scene.reference.world_from_camera *
                                  unproject(scene.reference.camera, 20, 50, depth);
    const auto expected = project(scene.partners[0].camera, point);
    const Eigen::Vector3d image = ray.at(20, 50, 1 / depth);
    EXPECT_NEAR(image.x() / image.z(), expected->x, 1e-9);
    EXPECT_NEAR(image.y() / image.z(), expected->y, 1e-9);
    EXPECT_NEAR(image.z() * depth, expected->depth, 1e-9);
  }
}

TEST(PaperRay, FromStepToStepTheWidestPartnersImageMovesByHalfAPixelAtMost) {
  const Scene scene = sceneOf(kFrontal);
  const paper::RaySteps steps = scene.steps();
  EXPECT_NEAR(1 / steps.inverseDepth(0), kDepths.far, 1e-9);
  EXPECT_NEAR(1 / steps.inverseDepth(steps.count - 1), kDepths.near, 1e-9);
  double greatest = 0;
  for (const Photograph& partner : scene.partners)
    for (int k = 0; k + 1 < steps.count; ++k) {
      const paper::RayImage ray = paper::rayImage(scene.reference, partner);
      const Eigen::Vector3d a = ray.at(47, 35, steps.inverseDepth(k)),
                            b = ray.at(47, 35, steps.inverseDepth(k + 1));
      greatest = std::max(greatest, (a.head<2>() / a.z() - b.head<2>() / b.z()).norm());
    }
  EXPECT_LE(greatest, kPaperStep);
  EXPECT_GT(greatest, 0.7 * kPaperStep);
}

TEST(Paper, OfAWallThatFacesTheCameraTheDepthIsRightToAFractionOfAStep) {
  const Scene scene = sceneOf(kFrontal);
  const StereoView result = match(scene);
  double sum = 0, pixels = 0;
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      if (distanceToRim(scene.truth, x, y) < kRadius) {
        EXPECT_EQ(result.view.map.depth(x, y), kInvalidDepth);
        EXPECT_EQ(result.view.map.confidence(x, y), 0);
      }
      // At the very rim the window leaves the pictures of all partners, at the sides those of two.
      if (distanceToRim(scene.truth, x, y) < 2 * kRadius) continue;
      EXPECT_LT(errorInSteps(scene, result, x, y), 0.4) << x << ", " << y;
      sum += errorInSteps(scene, result, x, y), ++pixels;
      EXPECT_GE(result.voters(x, y), 2);
      EXPECT_GT(result.view.map.confidence(x, y), 0.22f * result.voters(x, y));
      EXPECT_LE(result.view.map.confidence(x, y), 1.0f);
      EXPECT_LE(result.second_best(x, y), result.view.map.confidence(x, y));
    }
  EXPECT_LT(sum / pixels, 0.05);
  EXPECT_TRUE(validate(result.view).empty());
}

TEST(Paper, GainAndBiasOfEachPhotographChangeNothing) {
  const StereoView plain = match(middleOf(sceneOf(kOccluded)));
  const StereoView changed =
      match(middleOf(sceneOf(kOccluded, {0.5, 0.8, 0.7, 0.6, 0.9}, {0.3, 0.1, 0.2, 0.05, 0.0})));
  for (int y = 0; y < plain.voters.height(); ++y)
    for (int x = 0; x < plain.voters.width(); ++x) {
      EXPECT_NEAR(plain.view.map.depth(x, y), changed.view.map.depth(x, y), 1e-4) << x << ", " << y;
      EXPECT_NEAR(plain.view.map.confidence(x, y), changed.view.map.confidence(x, y), 1e-4);
    }
}

TEST(Paper, WhereHalfThePartnersAreOccludedVotesAreRightAndTheMeanOfTheCurvesIsNot) {
  const Scene scene = sceneOf(kOccluded);
  EXPECT_GT(shareRightOfHalfOccluded(scene, match(scene)), 0.9);
  EXPECT_LT(shareRightOfHalfOccluded(scene, match(scene, {.score = Score::Mean})), 0.6);
}

TEST(Paper, ConfidenceAndSharesOfAlternativesAreShares) {
  const Scene scene = middleOf(sceneOf(kOccluded));
  const StereoView result = match(scene, {.hypotheses = 3, .threshold = 0.2});
  const DepthMap& map = result.view.map;
  ASSERT_EQ(map.alternatives.size(), 2u);
  int second = 0;
  for (int y = 0; y < map.depth.height(); ++y)
    for (int x = 0; x < map.depth.width(); ++x) {
      EXPECT_GE(map.confidence(x, y), 0);
      EXPECT_LE(map.confidence(x, y), 1);
      const float shares = map.alternatives[0].share(x, y) + map.alternatives[1].share(x, y);
      EXPECT_LT(shares, 1);
      EXPECT_EQ(map.alternatives[0].depth(x, y) == kInvalidDepth, map.alternatives[0].share(x, y) == 0);
      EXPECT_GE(map.alternatives[0].share(x, y), map.alternatives[1].share(x, y));
      EXPECT_EQ(map.alternatives[0].share(x, y) > 0, result.second_best(x, y) > 0);
      if (map.alternatives[0].share(x, y) == 0) continue;
      EXPECT_NEAR(map.alternatives[0].share(x, y) / (1 - shares),
                  result.second_best(x, y) / map.confidence(x, y), 1e-3);
      ++second;
    }
  EXPECT_GT(second, 100);
  EXPECT_TRUE(validate(result.view).empty());
}

TEST(Paper, PixelsWithLessThanTheLeastConfidenceHaveNoDepth) {
  const Scene scene = middleOf(sceneOf(kOccluded));
  const StereoView all = match(scene), some = match(scene, {.min_confidence = 0.6});
  int dropped = 0;
  for (int y = 0; y < all.voters.height(); ++y)
    for (int x = 0; x < all.voters.width(); ++x) {
      const bool keep = all.view.map.confidence(x, y) >= 0.6f;
      dropped += keep ? 0 : 1;
      EXPECT_EQ(some.view.map.depth(x, y), keep ? all.view.map.depth(x, y) : kInvalidDepth);
      EXPECT_EQ(some.voters(x, y), keep ? all.voters(x, y) : 0);
    }
  EXPECT_GT(dropped, 2 * kRadius * 40 + 50);
}

TEST(Paper, WindowsOutsideTheMasksDoNotVote) {
  Scene scene = sceneOf(kFrontal);
  scene.reference.mask = Image<std::uint8_t>(96, 72, 255);
  for (int y = 0; y < 72; ++y) scene.reference.mask(30, y) = 0;
  scene.partners[0].mask = Image<std::uint8_t>(96, 72);  // sees nothing of the object
  const StereoView result = match(scene);
  EXPECT_EQ(result.view.map.mask, scene.reference.mask);
  for (int x = kRadius; x < 96 - kRadius; ++x) {
    const bool cut = std::abs(x - 30) <= kRadius;
    EXPECT_EQ(result.view.map.depth(x, 35) == kInvalidDepth, cut) << x;
    EXPECT_LE(result.voters(x, 35), 3);
    EXPECT_LE(result.view.map.confidence(x, 35), 0.75f);
  }
}

TEST(Paper, WhatHasNoTextureHasNoDepth) {
  Scene scene = sceneOf(kFrontal, {1, 1, 0.002, 1, 1}, {0, 0, 0.5, 0, 0});  // the reference
  for (const float depth : match(scene).view.map.depth) EXPECT_EQ(depth, kInvalidDepth);
  scene = sceneOf(kFrontal, {0.002, 0.002, 1, 0.002, 0.002}, {0.5, 0.5, 0, 0.5, 0.5});  // all partners
  for (const float depth : match(scene).view.map.depth) EXPECT_EQ(depth, kInvalidDepth);
}

TEST(Paper, AnyNumberOfThreadsGivesTheSameDepths) {
  const Scene scene = middleOf(sceneOf(kOccluded));
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return match(scene);
  };
  const StereoView one = with_threads(1), four = with_threads(4);
  EXPECT_EQ(one.view.map.depth, four.view.map.depth);
  EXPECT_EQ(one.view.map.confidence, four.view.map.confidence);
  EXPECT_EQ(one.second_best, four.second_best);
}

}  // namespace
}  // namespace vdbfuse::stereo
