// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/stereo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/temporary_folder.h"
#include "stereo/textured_planes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TexturedScene;

const DepthInterval kDepths{1.5, 2.7};
constexpr double kPixel = 0.007;  // inverse depth of about a pixel in the widest partner, for any photograph
const TexturedScene kScene({{.origin = {0, 0, 0.3}, .half_u = 3, .half_v = 3}},
                           {{.middle = {0, 0, 0.1}, .radius = 0.3, .seed = 4}});

std::vector<PhotographHeader> headers(int count) {
  std::vector<PhotographHeader> result = test::camerasOnArc(count, 10);
  for (PhotographHeader& header : result) header.depth = kDepths;
  return result;
}

const std::vector<Photograph>& photographs() {
  static const std::vector<Photograph> all = photographsOf(kScene, headers(5));
  return all;
}

StereoResult match(const std::vector<Photograph>& set, const StereoOptions& options = {}) {
  return computeDepthMaps(PhotographSequence::fromPhotographs(set), options);
}

// Of the first set of photographs, with the options as they are.
const StereoResult& plainResult() {
  static const StereoResult result = match(photographs());
  return result;
}

std::size_t depthsIn(const StereoView& view) {
  const Image<float>& depth = view.view.map.depth;
  return static_cast<std::size_t>(
      std::count_if(depth.begin(), depth.end(), [](float d) { return d != kInvalidDepth; }));
}

// Of the pixels with a confidence of one half, those within `pixels` of the expected depth.
double shareNear(const StereoView& view, const Image<float>& expected, double pixels) {
  const DepthMap& map = view.view.map;
  double near = 0, all = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (map.confidence.data()[i] < 0.5F) continue;
    const double off = 1 / double{map.depth.data()[i]} - 1 / double{expected.data()[i]};
    ++all;
    near += std::abs(off) < pixels * kPixel ? 1 : 0;
  }
  EXPECT_GT(all, 2500);
  return near / all;
}

TEST(Stereo, EveryViewHasItsPhotographsNamePoseAndPictureAndValidDepths) {
  const StereoResult& result = plainResult();
  ASSERT_EQ(result.views.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const StereoView& view = result.views[i];
    const Photograph& photograph = photographs()[i];
    EXPECT_TRUE(validate(view.view).empty());
    EXPECT_EQ(view.view.name, photograph.name);
    EXPECT_TRUE(view.view.world_from_camera.isApprox(photograph.world_from_camera));
    const auto grey = static_cast<std::uint8_t>(std::lround(255 * photograph.brightness(40, 30)));
    EXPECT_EQ(view.view.map.color(40, 30), (Rgb8{grey, grey, grey}));
    EXPECT_EQ(view.partners.size(), 4u);
    EXPECT_EQ(std::count(view.partners.begin(), view.partners.end(), i), 0);
    EXPECT_EQ(view.depths.near, kDepths.near);
    EXPECT_GT(view.matching_error_px, 0.01);
    EXPECT_LT(view.matching_error_px, 0.5);
    EXPECT_NEAR(view.noise.quadratic, view.matching_error_px * kPixel, 0.6 * view.noise.quadratic);
  }
  std::vector<std::string> steps;
  for (const StepTime& step : result.steps) steps.push_back(step.name);
  EXPECT_EQ(steps, (std::vector<std::string>{"match", "cross-check", "write"}));
}

TEST(Stereo, WhatHasNoDepthHasNoConfidenceAndNoVotersAndTheRestLiesWhereItWasLookedFor) {
  StereoOptions boxed;
  boxed.domain = Box(Eigen::Vector3d(-0.3, -0.3, -0.3), Eigen::Vector3d(0.3, 0.3, 0.25));
  for (const StereoResult& result : {plainResult(), match(photographs(), boxed)}) {
    for (const StereoView& view : result.views) {
      const DepthMap& map = view.view.map;
      for (std::size_t i = 0; i < map.depth.size(); ++i) {
        const float depth = map.depth.data()[i], confidence = map.confidence.data()[i];
        ASSERT_LE(view.second_best.data()[i], confidence);
        ASSERT_LE(confidence, 1);
        ASSERT_LE(view.voters.data()[i], 4);
        if (depth == kInvalidDepth) {
          ASSERT_EQ(confidence, 0);
          ASSERT_EQ(view.voters.data()[i], 0);
          continue;
        }
        ASSERT_GE(depth, kDepths.near * 0.9999);
        ASSERT_LE(depth, kDepths.far * 1.0001);
      }
    }
  }
}

TEST(Stereo, GainAndBiasOfEachPhotographChangeNothing) {
  std::vector<Photograph> changed;
  const double gains[] = {0.5, 0.8, 0.7, 0.6, 0.9}, biases[] = {0.3, 0.1, 0.2, 0.05, 0};
  for (std::size_t i = 0; i < 5; ++i)
    changed.push_back(photographOf(kScene, photographs()[i], gains[i], biases[i]));
  const StereoResult result = match(changed);
  // Up to the rounding of brightness to 2040 levels, of which half the gain leaves half.
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_GT(shareNear(result.views[i], plainResult().views[i].view.map.depth, 0.1), 0.95);
    EXPECT_GT(shareNear(result.views[i], plainResult().views[i].view.map.depth, 0.5), 0.99);
  }
}

TEST(Stereo, FaintTextureIsEnough) {
  std::vector<Photograph> faint;
  for (const Photograph& photograph : photographs())
    faint.push_back(photographOf(kScene, photograph, 0.1, 0.4));
  EXPECT_GT(shareNear(match(faint).views[2], trueDepthOf(kScene, photographs()[2]), 0.5), 0.9);
  // Below a grey level and a half there is none.
  for (Photograph& photograph : faint) photograph = photographOf(kScene, photograph, 0.01, 0.4);
  for (const StereoView& view : match(faint).views) EXPECT_EQ(depthsIn(view), 0u);
}

// A pyramid has as many levels as the largest photograph asks for.
TEST(Stereo, PhotographsOfDifferentSizesAreMatched) {
  std::vector<PhotographHeader> cameras = headers(3);
  Pinhole& large = cameras[1].camera;
  const double factor = 6;
  large.width *= 6, large.height *= 6, large.fx *= factor, large.fy *= factor;
  large.cx = (large.cx + 0.5) * factor - 0.5, large.cy = (large.cy + 0.5) * factor - 0.5;
  const StereoResult result = match(photographsOf(kScene, cameras));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_GT(shareNear(result.views[i], trueDepthOf(kScene, cameras[i]), 1), 0.8) << i;
}

TEST(Stereo, TwoPhotographsAreEnough) {
  const StereoResult result = match({photographs()[2], photographs()[3]});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(result.views[i].partners, std::vector<std::size_t>{1 - i});
    EXPECT_GT(shareNear(result.views[i], trueDepthOf(kScene, photographs()[2 + i]), 0.5), 0.7);
  }
}

TEST(Stereo, APhotographThatSharesNothingWithTheOthersHasAnEmptyMap) {
  std::vector<Photograph> set = photographs();
  set[4].world_from_camera.translation() += Eigen::Vector3d(100, 0, 0);
  const StereoResult result = match(set);
  EXPECT_TRUE(result.views[4].partners.empty());
  EXPECT_EQ(depthsIn(result.views[4]), 0u);
  EXPECT_TRUE(validate(result.views[4].view).empty());
  EXPECT_EQ(result.views[4].matching_error_px, 0);
  EXPECT_GT(depthsIn(result.views[2]), 5000u);
}

TEST(Stereo, WhatTheMasksHideHasNoDepthAndVotesForNone) {
  std::vector<Photograph> set = photographs();
  set[2].mask = Image<std::uint8_t>(96, 72, std::uint8_t{1});
  for (int y = 0; y < 72; ++y) set[2].mask(30, y) = 0;
  set[1].mask = Image<std::uint8_t>(96, 72);  // sees nothing of the object
  const StereoResult result = match(set);
  EXPECT_EQ(depthsIn(result.views[1]), 0u);
  EXPECT_EQ(result.views[2].view.map.mask, set[2].mask);
  for (int y = 0; y < 72; ++y) EXPECT_EQ(result.views[2].view.map.depth(30, y), kInvalidDepth);
  for (const std::uint8_t voters : result.views[2].voters) EXPECT_LE(voters, 3);
  EXPECT_GT(depthsIn(result.views[2]), 5000u);
}

// Whether the ray of a pixel comes within `slack` of the box: looked up along it.
bool meets(const Box& box, const View& view, int x, int y, double slack) {
  const Box wide(box.min().array() - slack, box.max().array() + slack);
  for (double z = 1; z < 3; z += 0.002)
    if (wide.contains(view.world_from_camera * unproject(view.projection, x, y, z))) return true;
  return false;
}

TEST(Stereo, NothingIsLookedForBesideTheBox) {
  StereoOptions options;
  options.domain = Box(Eigen::Vector3d(-0.3, -0.2, -0.3), Eigen::Vector3d(0.1, 0.2, 0.5));
  const StereoView view = match(photographs(), options).views[1];
  int outside = 0;
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x)
      if (!meets(*options.domain, view.view, x, y, 0.01)) {
        ++outside;
        EXPECT_EQ(view.view.map.depth(x, y), kInvalidDepth) << x << ", " << y;
      }
  EXPECT_GT(outside, 3000);
  EXPECT_GT(depthsIn(view), 500u);
}

TEST(Stereo, DepthsThatAreGivenReplaceThoseOfTheData) {
  StereoOptions options;
  options.min_depth = 1.2, options.max_depth = 2.2;  // the wall lies behind
  const StereoView view = match(photographs(), options).views[2];
  EXPECT_EQ(view.depths.near, 1.2);
  EXPECT_EQ(view.depths.far, 2.2);
  for (const float depth : view.view.map.depth)
    if (depth != kInvalidDepth) {
      ASSERT_GE(depth, 1.2 * 0.9999);
      ASSERT_LE(depth, 2.2 * 1.0001);
    }
  options.max_depth = 0;
  EXPECT_EQ(match(photographs(), options).views[2].depths.far, kDepths.far);
}

TEST(Stereo, PixelsWithLessThanTheLeastConfidenceHaveNoDepth) {
  StereoOptions options;
  options.min_confidence = 0.7;
  const DepthMap some = match(photographs(), options).views[2].view.map,
                 all = plainResult().views[2].view.map;
  int dropped = 0;
  for (std::size_t i = 0; i < all.depth.size(); ++i) {
    const bool keep = double{all.confidence.data()[i]} >= 0.7;
    dropped += all.depth.data()[i] > 0 && !keep ? 1 : 0;
    ASSERT_EQ(some.depth.data()[i], keep ? all.depth.data()[i] : kInvalidDepth);
  }
  EXPECT_GT(dropped, 100);
}

TEST(Stereo, AnyNumberOfThreadsGivesTheSameBytes) {
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return match(photographs());
  };
  const StereoResult one = with_threads(1), four = with_threads(4);
  for (std::size_t i = 0; i < 5; ++i) {
    const StereoView &a = one.views[i], &b = four.views[i];
    EXPECT_EQ(a.view.map.depth, b.view.map.depth);
    EXPECT_EQ(a.view.map.confidence, b.view.map.confidence);
    EXPECT_EQ(a.second_best, b.second_best);
    EXPECT_EQ(a.voters, b.voters);
    EXPECT_EQ(a.matching_error_px, b.matching_error_px);
  }
}

TEST(Stereo, SaysWhatIsWrongWithWhatItIsGiven) {
  EXPECT_EQ(messageOf<InvalidArgument>([] { match({photographs()[0]}); }),
            "photographs: expected at least two, found 1");
  StereoOptions options;
  options.window_px = 4;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { match(photographs(), options); }),
            "options: window_px must be odd, 3 to 15");
  options = {};
  options.min_depth = 3;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { match(photographs(), options); }),
            "depths: nothing is left between 3.000000 and 2.700000 for photograph camera 0");
}

TEST(Stereo, WhatStopsALoaderOrTheCallerStopsIt) {
  const PhotographSequence broken(
      headers(3), [](std::size_t, Photograph&) { throw IoError("picture.png", "", "a picture", "nothing"); });
  EXPECT_EQ(messageOf<IoError>([&] { computeDepthMaps(broken); }),
            "picture.png: expected a picture, found nothing");
  for (const char* stop : {"matching", "cross-checking"}) {
    const Progress progress([&](std::string_view step, double) { return step != stop; });
    EXPECT_THROW(computeDepthMaps(PhotographSequence::fromPhotographs(photographs()), {}, progress),
                 Cancelled);
  }
}

TEST(Stereo, OneLawOfNoiseForAllIsTheMedianOfThoseThatHaveOne) {
  StereoResult result;
  EXPECT_FALSE(medianNoise(result));
  result.views.resize(4);
  EXPECT_FALSE(medianNoise(result));
  result.views[0].noise.quadratic = 0.3, result.views[1].noise.quadratic = 0.1;
  result.views[3].noise.quadratic = 0.2;
  EXPECT_EQ(medianNoise(result), (NoiseLaw{0, 0, 0.2}));
}

TEST(StereoOptions, ListEverythingThatIsWrongWithThem) {
  StereoOptions options;
  EXPECT_TRUE(validate(options).empty());
  options.partners = {0, 10, 5}, options.window_px = 17, options.min_depth = -1, options.max_depth = INFINITY;
  options.hypotheses = 5, options.min_confidence = 2, options.surface_sweeps = 11;
  EXPECT_EQ(validate(options),
            (std::vector<std::string>{"partners.count must be 1 to 64",
                                      "the angles of partners must be 0 <= min < max <= 180 degrees",
                                      "window_px must be odd, 3 to 15", "min_depth must not be below 0",
                                      "max_depth must not be below 0", "hypotheses must be 1 to 4",
                                      "min_confidence must be in [0, 1]", "surface_sweeps must be 0 to 10"}));
  options = {};
  options.min_depth = 2, options.max_depth = 1;
  EXPECT_EQ(validate(options), std::vector<std::string>{"max_depth must be above min_depth"});
}

}  // namespace
}  // namespace vdbfuse
