// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/tsdf.h"

#include <gmock/gmock.h>

#include <cmath>

#include "fusion/scenes.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/likelihood.h"
#include "vdbfuse/fusion/measurement_weight.h"
#include "vdbfuse/surface/extract.h"

namespace vdbfuse {
namespace {

using testing::HasSubstr;

constexpr double kVoxel = 0.04, kTruncation = 0.12;

TsdfOptions options(TsdfStorage storage = TsdfStorage::Single) {
  TsdfOptions o;
  o.truncation = kTruncation;
  o.storage = storage;
  return o;
}

void integrate(const std::vector<View>& views, TsdfVolume& volume) {
  for (const View& view : views)
    volume.integrate({view, view.map.depth, nullptr, view.map.color.empty() ? nullptr : &view.map.color});
}

TsdfVolume fuse(const std::vector<View>& views, const TsdfOptions& o = options(), double voxel = kVoxel) {
  TsdfVolume volume({voxel}, o);
  integrate(views, volume);
  return volume;
}

// Views of a sphere whose pictures show where they look from.
std::vector<View> coloredViews(int count) {
  std::vector<View> views = test::sphereViews(count);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto shade = static_cast<std::uint8_t>(20 * i);
    views[i].map.color = Image<Rgb8>(64, 64, Rgb8{shade, 100, static_cast<std::uint8_t>(255 - shade)});
  }
  return views;
}

// Largest difference of two grids, and whether they know the same voxels.
struct Difference {
  float largest = 0;
  bool same_known = true;
};
Difference difference(const ScalarGrid& a, const ScalarGrid& b) {
  Difference result;
  if (a.leafCount() != b.leafCount()) return {0, false};
  for (std::size_t i = 0; i < a.leafCount(); ++i) {
    const auto left = a.leaf(i), right = b.leaf(i);
    if (left.origin != right.origin) return {0, false};
    for (std::size_t k = 0; k < left.values.size(); ++k) {
      if (std::isnan(left.values[k]) != std::isnan(right.values[k])) result.same_known = false;
      if (std::isnan(left.values[k]) || std::isnan(right.values[k])) continue;
      result.largest = std::max(result.largest, std::abs(left.values[k] - right.values[k]));
    }
  }
  return result;
}

void expectSame(const TsdfVolume& a, const TsdfVolume& b, float tolerance = 0) {
  const Difference distance = difference(a.distance(), b.distance()),
                   weight = difference(a.weight(), b.weight());
  EXPECT_TRUE(distance.same_known && weight.same_known);
  EXPECT_LE(distance.largest, tolerance);
  EXPECT_EQ(weight.largest, 0.0f);
}

TEST(Tsdf, TheZeroSetOfASphereLiesOnIt) {
  TsdfVolume volume({kVoxel}, options());
  for (const View& view : test::sphereViews(30, 96)) {
    const Image<float> weights = measurementWeights(view, std::nullopt, kVoxel, {});
    volume.integrate({view, view.map.depth, &weights});
  }
  const TriangleMesh mesh = extractSurface(volume.distance());
  EXPECT_GT(mesh.vertices.size(), 1000u);
  double sum = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    EXPECT_NEAR(v.norm(), 0.5, 0.3 * kVoxel);
    sum += v.norm() - 0.5;
  }
  EXPECT_NEAR(sum / static_cast<double>(mesh.vertices.size()), 0, 0.04 * kVoxel);
}

TEST(Tsdf, IsUnknownWhereNothingWasMeasured) {
  const TsdfVolume volume = fuse(test::sphereViews(30));
  const ScalarGrid distance = volume.distance(), weight = volume.weight();
  EXPECT_TRUE(std::isnan(distance.at({0, 0, 0})));
  EXPECT_TRUE(std::isnan(distance.at({1000, 0, 0})));
  EXPECT_EQ(weight.at({0, 0, 0}), 0.0f);
  for (std::size_t i = 0; i < distance.leafCount(); ++i) {
    const auto distances = distance.leaf(i).values, weights = weight.leaf(i).values;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      ASSERT_EQ(std::isnan(distances[k]), weights[k] == 0);
      if (weights[k] > 0) {
        ASSERT_LE(std::abs(distances[k]), kTruncation + 1e-6);
      }
    }
  }
}

TEST(Tsdf, VoxelsOfLittleWeightAreUnknownOnRequest) {
  const TsdfVolume volume = fuse(test::sphereViews(30));
  const ScalarGrid few = volume.distance(3.0f), weight = volume.weight();
  for (std::size_t i = 0; i < few.leafCount(); ++i)
    for (std::size_t k = 0; k < ScalarGrid::kLeafSize; ++k)
      ASSERT_EQ(std::isnan(few.leaf(i).values[k]), weight.leaf(i).values[k] <= 3);
}

TEST(Tsdf, OneViewLeavesTheBackOfTheSphereOpen) {
  const View front =
      test::castView({0, 0, 2}, {0, 0, 0}, test::cameraFor(64, 0.5, 2), test::sphereCaster(0.5));
  const ScalarGrid distance = fuse({front}).distance();
  EXPECT_FALSE(std::isnan(distance.at({0, 0, 12})));
  EXPECT_TRUE(std::isnan(distance.at({0, 0, -12})));
}

std::vector<View> twoPlanes() {
  View far = test::castView({0, 0, 2}, {0, 0, 0}, {16, 16, 20, 20, 7.5, 7.5, {}}, test::planeCaster(0));
  View near = far;
  for (float& d : near.map.depth) d -= 0.05f;
  return {far, near};
}

TEST(Tsdf, IsTheMeanOfTheTruncatedDistances) {
  const TsdfVolume volume = fuse(twoPlanes());
  // At z = 0.04 the surfaces z = 0 and z = 0.05 lie 0.04 behind and 0.01 in front.
  EXPECT_NEAR(volume.distance().at({0, 0, 1}), (0.04 - 0.01) / 2, 1e-5);
  EXPECT_NEAR(volume.distance().at({0, 0, 4}), (0.12 + 0.11) / 2, 1e-5);
  EXPECT_EQ(volume.weight().at({0, 0, 1}), 2.0f);
}

TEST(Tsdf, IsTheMeanByWeight) {
  const std::vector<View> views = twoPlanes();
  TsdfVolume volume({kVoxel}, options());
  const Image<float> heavy(16, 16, 3.0f), light(16, 16, 0.25f), none(16, 16, 0.0f);
  volume.integrate({views[0], views[0].map.depth, &heavy});
  volume.integrate({views[1], views[1].map.depth, &light});
  volume.integrate({views[1], views[1].map.depth, &none});
  EXPECT_NEAR(volume.distance().at({0, 0, 1}), (3 * 0.04 - 0.25 * 0.01) / 3.25, 1e-5);
  EXPECT_EQ(volume.weight().at({0, 0, 1}), 3.25f);
}

// A plane through the origin, tilted by 50°.
View tiltedView(const Projection& projection, double distance) {
  const Eigen::Vector3d normal(std::sin(0.87), 0, std::cos(0.87));
  View view;
  view.projection = projection;
  view.world_from_camera = lookAt({0, 0, distance}, {0, 0, 0}, {0, 1, 0});
  view.map.depth = Image<float>(imageWidth(projection), imageHeight(projection));
  for (int y = 0; y < view.map.depth.height(); ++y) {
    for (int x = 0; x < view.map.depth.width(); ++x) {
      const Eigen::Vector3d near = view.world_from_camera * unproject(projection, x, y, 1.0),
                            far = view.world_from_camera * unproject(projection, x, y, 2.0);
      const double depth = 1 - normal.dot(near) / normal.dot(far - near);
      if (depth > 0 && depth < 2 * distance) view.map.depth(x, y) = static_cast<float>(depth);
    }
  }
  return view;
}

// Depth of the plane on the ray of a voxel minus that of the voxel.
double planeDistance(const View& view, const Eigen::Vector3d& voxel) {
  const Eigen::Vector3d normal(std::sin(0.87), 0, std::cos(0.87));
  const auto seen = project(view.projection, view.world_from_camera.inverse() * voxel);
  const Eigen::Vector3d near = view.world_from_camera * unproject(view.projection, seen->x, seen->y, 1.0),
                        far = view.world_from_camera * unproject(view.projection, seen->x, seen->y, 2.0);
  return 1 - normal.dot(near) / normal.dot(far - near) - seen->depth;
}

TEST(Tsdf, DepthIsReadBetweenThePixelsOfEverySensor) {
  const std::pair<const char*, Projection> sensors[] = {
      {"pinhole", Pinhole{64, 48, 60, 60, 31.5, 23.5, {}}},
      {"distorted pinhole", Pinhole{64, 48, 60, 60, 31.5, 23.5, {0.05, -0.01, 0.001, 0.001, 0}}},
      {"spherical", Spherical{64, 48, -0.5, 1.0 / 63, -0.4, 0.8 / 47}},
      {"orthographic", Orthographic{64, 48, -1, 2.0 / 63, -0.8, 1.6 / 47}},
      {"push-broom", PushBroom{64, 48, -1, 2.0 / 63, 0.1, 60, 23.5}},
  };
  for (const auto& [name, projection] : sensors) {
    const View view = tiltedView(projection, 2);
    const TsdfVolume volume = fuse({view});
    const ScalarGrid distance = volume.distance();
    std::size_t checked = 0;
    for (std::size_t i = 0; i < distance.leafCount(); ++i) {
      for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
        const float value = distance.leaf(i).values[static_cast<std::size_t>(k)];
        if (std::isnan(value) || std::abs(value) > 0.6 * kTruncation) continue;
        const Eigen::Vector3d voxel =
            kVoxel * (distance.leaf(i).origin + Index3(k >> 6, k >> 3 & 7, k & 7)).cast<double>();
        const auto seen = project(projection, view.world_from_camera.inverse() * voxel);
        // Beside the image there is only the outermost pixel; far away the plane is seen too steeply.
        if (seen->depth > 2.5) continue;
        if (seen->x < 0 || seen->y < 0 || seen->x > 63 || seen->y > 47) continue;
        ASSERT_NEAR(value, planeDistance(view, voxel), 0.04 * kVoxel) << name << " " << voxel.transpose();
        ++checked;
      }
    }
    EXPECT_GT(checked, 500u) << name;
  }
}

TEST(Tsdf, DepthEdgesAreNotInterpolatedAcross) {
  View step = test::castView({0, 0, 2}, {0, 0, 0}, {32, 32, 40, 40, 15.5, 15.5, {}}, test::planeCaster(0));
  const float far = step.map.depth(0, 0), near = far - 0.8f;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 16; ++x) step.map.depth(x, y) = near;
  const ScalarGrid distance = fuse({step}).distance();
  for (std::size_t i = 0; i < distance.leafCount(); ++i) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const float value = distance.leaf(i).values[static_cast<std::size_t>(k)];
      if (std::isnan(value) || std::abs(value) > 0.99 * kTruncation) continue;
      // Every known distance is to one of the two planes.
      const double depth = 2 - kVoxel * (distance.leaf(i).origin.z() + (k & 7));
      ASSERT_LT(std::min(std::abs(far - depth - value), std::abs(near - depth - value)), 1e-4);
    }
  }
}

TEST(Tsdf, TheSameComesOutForEveryNumberOfThreads) {
  const std::vector<View> views = coloredViews(12);
  TsdfOptions o = options();
  o.colors = TsdfColors::Keep;
  std::vector<TsdfVolume> volumes;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    volumes.push_back(fuse(views, o));
    for (const View& view : views) volumes.back().carve({view, view.map.depth});
  }
  for (std::size_t i = 1; i < volumes.size(); ++i) {
    expectSame(volumes[0], volumes[i]);
    ASSERT_EQ(volumes[0].leafCount(), volumes[i].leafCount());
    for (std::size_t leaf = 0; leaf < volumes[0].leafCount(); ++leaf)
      ASSERT_EQ(volumes[0].leafOriginOf(leaf), volumes[i].leafOriginOf(leaf));
  }
}

TEST(Tsdf, TakingViewsOutLeavesWhatTheOthersMake) {
  std::vector<View> views = test::sphereViews(40);
  test::addNoise(views, {0.01, 0, 0}, 3);
  Image<float> weight(64, 64);
  for (int i = 0; i < 64 * 64; ++i) weight.data()[i] = 0.03f + 0.0123f * static_cast<float>(i % 70);
  for (const TsdfStorage storage : {TsdfStorage::Single, TsdfStorage::Half}) {
    TsdfVolume all({kVoxel}, options(storage)), half({kVoxel}, options(storage));
    for (const View& view : views) all.integrate({view, view.map.depth, &weight});
    for (std::size_t i = 0; i < 20; ++i) all.remove({views[2 * i], views[2 * i].map.depth, &weight});
    for (std::size_t i = 0; i < 20; ++i)
      half.integrate({views[2 * i + 1], views[2 * i + 1].map.depth, &weight});
    expectSame(all, half, storage == TsdfStorage::Single ? 1e-5f : 2e-2f * kTruncation);
    for (std::size_t i = 0; i < 20; ++i) all.remove({views[2 * i + 1], views[2 * i + 1].map.depth, &weight});
    EXPECT_EQ(all.distance().leafCount(), 0u);
  }
}

TEST(Tsdf, AVolumeWrittenReadAndContinuedIsOneNeverWritten) {
  const test::TemporaryFolder folder;
  const std::vector<View> views = coloredViews(12);
  const std::vector<View> first(views.begin(), views.begin() + 7), rest(views.begin() + 7, views.end());
  for (const TsdfStorage storage : {TsdfStorage::Single, TsdfStorage::Half}) {
    TsdfOptions o = options(storage);
    o.colors = TsdfColors::Keep,
    o.domain = Box(Eigen::Vector3d(-0.6, -0.6, -0.3), Eigen::Vector3d(0.6, 0.6, 0.6));
    const GridFrame frame{kVoxel / 3, {0.1, 1.0 / 3, 0}};
    TsdfVolume never({frame}, o), part({frame}, o);
    integrate(views, never), integrate(first, part);
    part.write(folder.path() / "volume.vdb");
    TsdfVolume read = TsdfVolume::read(folder.path() / "volume.vdb");
    EXPECT_EQ(read.frame().voxel, frame.voxel);
    EXPECT_EQ(read.options().storage, storage);
    integrate(rest, read);
    expectSame(never, read);
    TriangleMesh a = extractSurface(never.distance()), b = a;
    never.describeVertices(a), read.describeVertices(b);
    EXPECT_EQ(a.colors, b.colors);
    EXPECT_EQ(a.support, b.support);
  }
}

TEST(Tsdf, AGridThatIsNoVolumeIsRefusedByName) {
  const test::TemporaryFolder folder;
  const ScalarGrid surface("surface", {kVoxel}, kUnknown, {{0, 0, 0}}),
      weight("weight", {kVoxel}, 0.0f, {{0, 0, 0}});
  writeGrids(folder.path() / "other.vdb", {&surface, &weight});
  try {
    TsdfVolume::read(folder.path() / "other.vdb");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("other.vdb"));
    EXPECT_THAT(error.what(), HasSubstr("a volume written by vdbfuse"));
  }
  EXPECT_THROW(TsdfVolume::read(folder.path() / "nothing.vdb"), IoError);
}

TEST(Tsdf, HalfStorageDiffersByItsStepAndTakesHalfTheMemory) {
  const std::vector<View> views = test::sphereViews(30);
  const TsdfVolume single = fuse(views), half = fuse(views, options(TsdfStorage::Half));
  expectSame(single, half, 3e-3f * kTruncation);
  // The index of so small a volume counts.
  EXPECT_LT(half.memoryBytes(), 0.8 * static_cast<double>(single.memoryBytes()));
}

TEST(Tsdf, CarvingTakesAwayWhatOthersSeeThrough) {
  std::vector<View> views;
  for (int i = 0; i < 9; ++i)
    views.push_back(test::castView({0.3 * (i % 3 - 1), 0.3 * (i / 3 - 1), 2}, {0, 0, 0},
                                   {64, 64, 80, 80, 31.5, 31.5, {}}, test::planeCaster(0)));
  // A floating patch in one of them.
  for (int y = 24; y < 40; ++y)
    for (int x = 24; x < 40; ++x) views[4].map.depth(x, y) = 1.4f;
  const auto floats = [](const TsdfVolume& volume) {
    std::size_t count = 0;
    for (const Eigen::Vector3f& v : extractSurface(volume.distance()).vertices) count += v.z() > 0.3f ? 1 : 0;
    return count;
  };
  TsdfVolume volume = fuse(views);
  EXPECT_GT(floats(volume), 30u);
  const std::size_t leaves = volume.leafCount();
  for (const View& view : views) volume.carve({view, view.map.depth});
  EXPECT_EQ(floats(volume), 0u);
  EXPECT_EQ(volume.leafCount(), leaves);
  EXPECT_THROW(volume.remove({views[0], views[0].map.depth}), InvalidArgument);
}

TEST(Tsdf, CarvingDoesNotDependOnTheOrderOfTheViewsAndMakesNothingKnown) {
  const std::vector<View> views = test::sphereViews(10);
  const TsdfVolume whole = fuse(views);
  TsdfVolume forth = fuse(views), back = fuse(views);
  for (std::size_t i = 0; i < views.size(); ++i) {
    forth.carve({views[i], views[i].map.depth});
    const View& other = views[views.size() - 1 - i];
    back.carve({other, other.map.depth});
  }
  expectSame(forth, back, 1e-5f);
  EXPECT_TRUE(difference(whole.distance(), forth.distance()).same_known);
}

TEST(Tsdf, ASingleWrongDepthDoesNotCarve) {
  const std::vector<View> views(
      3, test::castView({0, 0, 2}, {0, 0, 0}, {64, 64, 80, 80, 31.5, 31.5, {}}, test::planeCaster(0)));
  TsdfVolume volume = fuse(views);
  View wrong = views[0];
  wrong.map.depth(32, 32) = wrong.map.depth(20, 20) = 5;
  const ScalarGrid before = volume.distance();
  volume.carve({wrong, wrong.map.depth});
  EXPECT_EQ(difference(before, volume.distance()).largest, 0.0f);
}

TEST(Tsdf, VerticesTakeTheColourThatTheirViewsHave) {
  View view = test::castView({0, 0, 2}, {0, 0, 0}, {64, 64, 80, 80, 31.5, 31.5, {}}, test::planeCaster(0));
  view.map.color = Image<Rgb8>(128, 128);  // twice as fine
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      view.map.color(x, y) = {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(2 * y), 77};
  TsdfOptions o = options();
  o.colors = TsdfColors::Keep;
  const TsdfVolume volume = fuse({view, view}, o);
  TriangleMesh mesh = extractSurface(volume.distance());
  volume.describeVertices(mesh);
  ASSERT_GT(mesh.vertices.size(), 200u);
  const RigidTransform camera_from_world = view.world_from_camera.inverse();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto seen = project(view.projection, camera_from_world * mesh.vertices[v].cast<double>());
    if (seen->x < 1 || seen->y < 1 || seen->x > 62 || seen->y > 62) continue;
    EXPECT_NEAR(mesh.colors[v][0], 2 * (2 * seen->x + 0.5), 6);
    EXPECT_NEAR(mesh.colors[v][1], 2 * (2 * seen->y + 0.5), 6);
    EXPECT_EQ(mesh.colors[v][2], 77);
    EXPECT_NEAR(mesh.support[v], 2, 0.01);
  }
}

TEST(Tsdf, LeavesOutsideTheDomainAreNotMade) {
  TsdfOptions o = options();
  o.domain = Box(Eigen::Vector3d(0.1, -1, -1), Eigen::Vector3d(1, 1, 1));
  const TsdfVolume volume = fuse(test::sphereViews(20), o);
  EXPECT_GT(volume.leafCount(), 10u);
  for (std::size_t leaf = 0; leaf < volume.leafCount(); ++leaf)
    EXPECT_GE(kVoxel * (volume.leafOriginOf(leaf).x() + 7), 0.1);
}

TEST(Tsdf, OneWildDepthMakesAFewLeavesAndNotThousands) {
  View view = test::sphereViews(1)[0];
  const std::size_t before = fuse({view}).leafCount();
  view.map.depth(32, 32) = 1.7e7f;
  view.map.depth(10, 10) = 30.0f;
  EXPECT_LT(fuse({view}).leafCount(), before + 100);
}

TEST(Tsdf, InputThatDoesNotFitIsRefusedWithItsSizes) {
  const View view = test::sphereViews(1)[0];
  TsdfVolume volume({kVoxel}, options());
  const Image<float> small(32, 64, 1.0f), thin(1, 64);
  for (const TsdfInput& input : {TsdfInput{view, small}, TsdfInput{view, view.map.depth, &small}}) {
    try {
      volume.integrate(input);
      FAIL();
    } catch (const InvalidArgument& error) {
      EXPECT_THAT(error.what(), HasSubstr("view 'view': 32x64 pixels, the projection has 64x64"));
    }
  }
  EXPECT_EQ(volume.changes(), 0u);
  EXPECT_THROW(TsdfVolume({0.0}, options()), InvalidArgument);
  EXPECT_THROW(TsdfVolume({kVoxel}, TsdfOptions()), InvalidArgument);
}

TEST(Tsdf, TheTruncationOfAnOutlierShareIsWhereTheLogOddsLevelOff) {
  constexpr double kNoise = 0.01;
  for (const double share : {0.001, 0.01, 0.1}) {
    const double scale = kNoise * std::sqrt(3) / M_PI;  // of the logistic with that deviation
    const SensorModel sensor{logisticNoise(), {scale, 0, 0}, 0.0, 2.0};
    // In the middle of the range: t = ½ well before the measurement at 1.
    const double far_before = logVisibleOdds(sensor, {1.0, scale, share}, 1.0 - 40 * scale);
    EXPECT_NEAR(truncationFor(kNoise, share), scale * far_before, 0.1 * truncationFor(kNoise, share))
        << share;
  }
  EXPECT_THROW(truncationFor(0.01, 0), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
