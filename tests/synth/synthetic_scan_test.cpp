// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/synth/synthetic_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

const Scene& sphereScene() {
  static const Scene scene = makeScene("sphere", {1.0 / 100});
  return scene;
}
const double kSphereRadius = 0.5 / std::sqrt(3.0);

SynthOptions exact(int views = 1) {
  SynthOptions options;
  options.views = views, options.width = 160, options.height = 120;
  options.noise_scale = 0, options.confidence = ConfidenceKind::None;
  return options;
}

ScanStatistics total(const SyntheticScan& scan) {
  ScanStatistics sum;
  for (const SyntheticView& view : renderAll(scan)) sum += statistics(view);
  return sum;
}

double share(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

// Deviation of measured from true depth where `keep` says so.
template <class Keep>
std::vector<double> deviations(const SyntheticView& view, Keep keep) {
  std::vector<double> result;
  for (std::size_t i = 0; i < view.mistake.size(); ++i) {
    const double measured = view.view.map.depth.data()[i], truth = view.true_depth.data()[i];
    if (measured > 0 && truth > 0 && keep(view.mistake.data()[i])) result.push_back((measured - truth));
  }
  return result;
}

TEST(SyntheticScan, TheDepthOfASphereIsTheClosedForm) {
  const SyntheticView view = SyntheticScan(sphereScene(), exact()).render(0);
  const auto& camera = std::get<Pinhole>(view.view.projection);
  int compared = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      const Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1);
      const double a = ray.squaredNorm(), b = kCameraDistance;
      const double under_root = b * b - a * (b * b - kSphereRadius * kSphereRadius);
      const float depth = view.view.map.depth(x, y);
      if (under_root < -1e-3) {
        EXPECT_EQ(depth, kInvalidDepth);
      }
      if (under_root < 1e-3) continue;
      EXPECT_NEAR(depth, (b - std::sqrt(under_root)) / a, 1e-6);
      ++compared;
    }
  EXPECT_GT(compared, 2000);
}

TEST(SyntheticScan, AMeshSceneIsCastAsItIs) {
  const Scene scene = sceneFromMesh("box", test::box({-1, -1, -1}, {1, 1, 1}));
  SynthOptions options = exact();
  options.arc = Arc::Ring;
  const SyntheticView view = SyntheticScan(scene, options).render(0);
  const Box bounds = boundingBox(scene.truth);
  int compared = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      if (view.view.map.depth(x, y) == kInvalidDepth) continue;
      EXPECT_NEAR(bounds.exteriorDistance(worldPoint(view.view, x, y)), 0, 1e-6);
      ++compared;
    }
  EXPECT_GT(compared, 2000);
}

TEST(SyntheticScan, TheNoiseHasTheScaleAndTheLawThatWereAskedFor) {
  for (const SynthNoise law : {SynthNoise::Stereo, SynthNoise::StructuredLight, SynthNoise::Constant}) {
    SynthOptions options = exact();
    options.noise_scale = 0.002, options.noise_law = law, options.width = 320, options.height = 240;
    const SyntheticView view = SyntheticScan(sphereScene(), options).render(0);
    double sum = 0, squares = 0;
    int count = 0;
    for (std::size_t i = 0; i < view.true_depth.size(); ++i) {
      const double truth = view.true_depth.data()[i];
      if (truth <= 0) continue;
      const double z = (view.view.map.depth.data()[i] - truth) / noiseSigma(options, truth);
      sum += z, squares += z * z, ++count;
    }
    EXPECT_NEAR(sum / count, 0, 0.04);
    EXPECT_NEAR(squares / count, 1, 0.06);
    EXPECT_DOUBLE_EQ(noiseSigma(options, 1.0), 0.002);
  }
}

TEST(SyntheticScan, StereoNoiseGrowsWithTheSquareOfTheDepthAndStructuredLightAsMeasuredByNguyen) {
  SynthOptions options;
  EXPECT_DOUBLE_EQ(noiseSigma(options, 3), 9 * noiseSigma(options, 1));
  options.noise_law = SynthNoise::StructuredLight, options.noise_scale = 1.2 + 1.9 * 0.36;
  EXPECT_NEAR(noiseSigma(options, 2.4), 1.2 + 1.9 * 4, 1e-12);
}

TEST(SyntheticScan, NoiseInPixelsIsAMatchingErrorOfTheStereoPair) {
  SynthOptions options;
  options.noise_px = 0.5;
  const double disparity_px = focalLength(options) * options.baseline / 1.5;
  const double further = focalLength(options) * options.baseline / (disparity_px - 0.5);
  EXPECT_NEAR(noiseSigma(options, 1.5), further - 1.5, 0.01 * noiseSigma(options, 1.5));
}

TEST(SyntheticScan, TheKinectSeesTheBallFromAboveInMillimetres) {
  SynthOptions options = kinectOptions();
  EXPECT_NEAR(noiseSigma(options, 1.4), 0.0012 + 0.0019, 1e-9);
  options.noise_scale = 0;
  const SyntheticScan scan(makeScene("ball", {0.05}), options);
  ASSERT_EQ(scan.size(), 24u);
  const SyntheticView view = scan.render(5);
  EXPECT_GT(view.view.world_from_camera.translation().z(), 0);
  EXPECT_EQ(std::get<Pinhole>(view.view.projection).fx, 525);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < view.true_depth.size(); ++i) {
    const float depth = view.view.map.depth.data()[i], truth = view.true_depth.data()[i];
    if (!(truth > 0)) continue;
    ++seen;
    ASSERT_NEAR(depth, truth, 0.00051);
    ASSERT_NEAR(depth * 1000, std::round(depth * 1000), 1e-3);
  }
  EXPECT_GT(seen, 50000u);
}

TEST(SyntheticScan, OutliersHaveTheShareThatWasAskedForEverywhere) {
  SynthOptions options = exact(8);
  options.outliers = 0.1;
  const ScanStatistics s = total(SyntheticScan(sphereScene(), options));
  EXPECT_NEAR(share(s.object_wrong, s.object_measured), 0.1, 0.01);
  EXPECT_NEAR(share(s.background_wrong, s.pixels - s.object_pixels), 0.1, 0.01);
  EXPECT_EQ(s.background_wrong, s.background_measured);
}

TEST(SyntheticScan, OutliersAreUniformInTheRange) {
  SynthOptions options = exact();
  options.outliers = 1;
  const DepthRange range = depthRange(options);
  std::array<int, 4> quarter{};
  const SyntheticView view = SyntheticScan(sphereScene(), options).render(0);
  for (const float depth : view.view.map.depth) {
    ASSERT_GE(depth, range.near);
    ASSERT_LT(depth, range.far);
    ++quarter[static_cast<std::size_t>(4 * (depth - range.near) / (range.far - range.near))];
  }
  for (const int count : quarter) EXPECT_NEAR(share(count, view.mistake.size()), 0.25, 0.02);
}

TEST(SyntheticScan, MissingPixelsHaveTheShareThatWasAskedFor) {
  SynthOptions options = exact(4);
  options.missing = 0.5;
  const ScanStatistics s = total(SyntheticScan(sphereScene(), options));
  EXPECT_NEAR(share(s.object_measured, s.object_pixels), 0.5, 0.01);
}

TEST(SyntheticScan, WithoutMistakesNoPixelIsWrong) {
  SynthOptions options = exact(2);
  options.noise_scale = 0.01;
  EXPECT_EQ(total(SyntheticScan(sphereScene(), options)).object_wrong, 0u);
}

TEST(SyntheticScan, HardViewsHoldPatchesAtAWrongDepth) {
  SynthOptions options = hardened(exact());
  options.outliers = 0, options.width = 640, options.height = 480, options.seed = 1;
  const SyntheticView view = SyntheticScan(sphereScene(), options).render(0);
  const auto isPatch = [](std::uint8_t m) { return m == static_cast<std::uint8_t>(Mistake::Patch); };
  const std::vector<double> shifts = deviations(view, isPatch);
  EXPECT_GT(shifts.size(), 2000u);
  EXPECT_LT(shifts.size(), 11000u);
  for (const double shift : shifts) {
    EXPECT_GT(std::abs(shift), 0.0199);
    EXPECT_LT(std::abs(shift), 0.51);  // where two patches overlap
  }
}

TEST(SyntheticScan, HardViewsMixHalfOfTheSilhouetteWithWhatLiesBehind) {
  SynthOptions options = hardened(exact());
  options.outliers = 0, options.width = 640, options.height = 480, options.background = Background::Wall;
  const SyntheticView view = SyntheticScan(sphereScene(), options).render(0);
  int rim = 0, mixed = 0;
  for (int y = 2; y < 478; ++y)
    for (int x = 2; x < 638; ++x) {
      const auto kind = static_cast<Mistake>(view.mistake(x, y));
      const bool at_rim = view.object(x, y) && (!view.object(x - 1, y) || !view.object(x + 1, y) ||
                                                !view.object(x, y - 1) || !view.object(x, y + 1));
      if (kind == Mistake::Mixed) {
        EXPECT_GT(view.view.map.depth(x, y), view.true_depth(x, y));
        EXPECT_LT(view.view.map.depth(x, y), kCameraDistance + kWallRadius);
      }
      if (!at_rim || kind == Mistake::Patch) continue;
      ++rim, mixed += kind == Mistake::Mixed ? 1 : 0;
    }
  EXPECT_NEAR(share(mixed, rim), 0.5, 0.1);
}

TEST(SyntheticScan, HardViewsHaveTheShareOfWrongPixelsThatTheNameStandsFor) {
  SynthOptions options = hardened({});
  options.views = 6;
  const ScanStatistics s = total(SyntheticScan(makeScene("torus", {1.0 / 160}), options));
  EXPECT_GT(share(s.object_wrong, s.object_measured), 0.22);
  EXPECT_LT(share(s.object_wrong, s.object_measured), 0.33);
}

TEST(SyntheticScan, InformativeConfidencesTellMistakesApartAndOverlappingOnesHardly) {
  for (const auto& [kind, low, high] : {std::tuple{ConfidenceKind::Informative, 0.98, 1.0},
                                        std::tuple{ConfidenceKind::Overlapping, 0.65, 0.85}}) {
    SynthOptions options = exact();
    options.outliers = 0.3, options.confidence = kind;
    const SyntheticView view = SyntheticScan(sphereScene(), options).render(0);
    std::vector<float> right, wrong;
    for (std::size_t i = 0; i < view.mistake.size(); ++i)
      if (view.view.map.depth.data()[i] > 0)
        (view.mistake.data()[i] ? wrong : right).push_back(view.view.map.confidence.data()[i]);
    std::size_t ordered = 0;
    for (std::size_t i = 0; i < 20000; ++i)
      ordered += right[i * 7 % right.size()] > wrong[i * 13 % wrong.size()] ? 1 : 0;
    EXPECT_GT(share(ordered, 20000), low);
    EXPECT_LE(share(ordered, 20000), high);
  }
}

TEST(SyntheticScan, WithoutConfidenceThereIsNoImageOfIt) {
  EXPECT_TRUE(SyntheticScan(sphereScene(), exact()).render(0).view.map.confidence.empty());
}

TEST(SyntheticScan, AWallCoversEveryPixelAndLiesOnItsSphere) {
  SynthOptions options = exact();
  options.background = Background::Wall;
  const SyntheticView view = SyntheticScan(sphereScene(), options).render(0);
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x) {
      ASSERT_GT(view.view.map.depth(x, y), 0);
      const double radius = worldPoint(view.view, x, y).norm();
      EXPECT_NEAR(radius, view.object(x, y) ? kSphereRadius : kWallRadius, 1e-5);
    }
}

TEST(SyntheticScan, CamerasInARoomSeeTheRoomEverywhere) {
  SynthOptions options = exact(6);
  options.arc = Arc::Room;
  const SyntheticScan scan(sphereScene(), options);
  const ScanStatistics s = total(scan);
  EXPECT_EQ(s.object_measured, s.pixels);
  const SyntheticView view = scan.render(1);
  for (int y = 0; y < options.height; y += 7)
    for (int x = 0; x < options.width; x += 7)
      EXPECT_NEAR(scan.scene().distance(worldPoint(view.view, x, y)), 0, 1e-5);
}

TEST(SyntheticScan, IsTheSameForOneThreadAndTwo) {
  SynthOptions options = hardened(exact(3));
  options.noise_scale = 0.001, options.missing = 0.1;
  const Scene mesh_scene = sceneFromMesh("ball", test::sphere(1.0, 4));
  for (const Scene& scene : {sphereScene(), mesh_scene}) {
    const auto render = [&](int threads) {
      const ThreadLimit limit(threads);
      return renderAll(SyntheticScan(scene, options));
    };
    const std::vector<SyntheticView> one = render(1), two = render(2);
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].view.map.depth, two[i].view.map.depth);
      EXPECT_EQ(one[i].view.map.confidence, two[i].view.map.confidence);
      EXPECT_EQ(one[i].mistake, two[i].mistake);
    }
  }
}

TEST(SyntheticScan, AnotherSeedMakesOtherMistakesAndTheSameTruth) {
  SynthOptions options = hardened(exact());
  const SyntheticView one = SyntheticScan(sphereScene(), options).render(0);
  options.seed = 2;
  const SyntheticView two = SyntheticScan(sphereScene(), options).render(0);
  EXPECT_EQ(one.true_depth, two.true_depth);
  EXPECT_NE(one.view.map.depth, two.view.map.depth);
}

TEST(SyntheticScan, TheSequenceOfViewsIsWhatIsRenderedAndOutlivesTheScan) {
  const SynthOptions options = hardened(exact(2));
  const ViewSequence views = SyntheticScan(sphereScene(), options).views();
  const View expected = SyntheticScan(sphereScene(), options).render(1).view;
  EXPECT_EQ(views.size(), 2u);
  EXPECT_EQ(views.load(1).map.depth, expected.map.depth);
  EXPECT_EQ(views.load(1).name, "00000001");
}

TEST(SyntheticScan, EverythingThatIsWrongWithTheOptionsIsListed) {
  SynthOptions options;
  options.views = 0, options.width = -1, options.noise_scale = -1, options.noise_px = -1,
  options.baseline = 0;
  options.outliers = 1.5, options.missing = std::nan(""), options.arc = Arc::Room;
  options.background = Background::Wall;
  EXPECT_EQ(validate(options).size(), 8u);
  EXPECT_TRUE(validate(SynthOptions{}).empty());
  try {
    const SyntheticScan scan(sphereScene(), options);
    FAIL() << "accepted";
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("views must be positive"),
                                             testing::HasSubstr("missing pixels must lie in [0, 1]")));
  }
}

TEST(SyntheticScan, StopsWhenTheProgressSaysSo) {
  const Progress progress([](std::string_view, double) { return false; });
  EXPECT_THROW(renderAll(SyntheticScan(sphereScene(), exact(2)), progress), Cancelled);
}

}  // namespace
}  // namespace vdbfuse
