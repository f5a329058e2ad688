// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/reconstruct.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "fusion/scenes.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using testing::HasSubstr;

std::vector<View> noisySphere(int views = 20) {
  std::vector<View> all = test::sphereViews(views, 64);
  test::addNoise(all, {0.004, 0, 0}, 6);
  return all;
}

ReconstructOptions coarse() {
  ReconstructOptions options;
  options.resolution = 40;
  return options;
}

Reconstruction run(std::vector<View> views, const ReconstructOptions& options = coarse()) {
  return reconstruct(ViewSequence::fromViews(std::move(views)), options);
}

TEST(Reconstruct, ANoisySphereIsOneClosedSphereOfTheRightSize) {
  const Reconstruction result = run(noisySphere());
  const TopologyReport report = topology(result.mesh);
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.euler_number, 2);
  for (const Eigen::Vector3f& v : result.mesh.vertices) ASSERT_NEAR(v.norm(), 0.5, result.grid.voxel);
  EXPECT_NEAR(signedVolume(result.mesh) / (4.0 / 3 * M_PI * 0.125), 1, 0.02);
  EXPECT_NEAR(result.calibration.noise_scale, 0.004, 0.001);
  EXPECT_LT(result.invented_area_share, 0.05);
  ASSERT_TRUE(result.cut);
  EXPECT_TRUE(result.cut->certified);
  EXPECT_EQ(result.cut->border, Border::Outside);
  EXPECT_EQ(result.mesh.normals.size(), result.mesh.vertices.size());
  EXPECT_EQ(result.mesh.support.size(), result.mesh.vertices.size());
  EXPECT_EQ(result.width, 64u);
  std::vector<std::string> names;
  for (const StepTime& s : result.steps) names.push_back(s.name);
  EXPECT_THAT(names, testing::ElementsAre("plan", "load", "calibrate", "judge", "agreement", "octree",
                                          "evidence", "cut", "surface"));
}

TEST(Reconstruct, VoxelsFinerThanTheNoiseMakeNoHandles) {
  std::vector<View> views = test::sphereViews(30, 96);
  test::addNoise(views, {0.015, 0, 0}, 6);
  ReconstructOptions options;
  options.voxel = 0.006;
  const TriangleMesh with_tension = run(views, options).mesh;
  EXPECT_EQ(topology(with_tension).components, 1u);
  EXPECT_EQ(topology(with_tension).euler_number, 2);
  options.least_cost = 0.0;
  EXPECT_LT(topology(run(views, options).mesh).euler_number, 0);
}

TEST(Reconstruct, IsTheSameMeshToTheLastBitForOneAndTwoThreads) {
  for (const Method method : {Method::Visibility, Method::Tsdf}) {
    ReconstructOptions options = coarse();
    options.method = method;
    const auto on = [&](int threads) {
      const ThreadLimit limit(threads);
      return run(noisySphere(), options).mesh;
    };
    const TriangleMesh one = on(1), two = on(2);
    EXPECT_EQ(one.vertices, two.vertices);
    EXPECT_EQ(one.triangles, two.triangles);
    EXPECT_EQ(one.normals, two.normals);
    EXPECT_EQ(one.support, two.support);
  }
}

TEST(Reconstruct, ARoomSeenFromWithinIsSolidAroundItsInside) {
  std::vector<View> views;
  for (int i = 0; i < 24; ++i) {
    const Eigen::Vector3d eye = 0.3 * test::fibonacciDirection(i, 24);
    views.push_back(test::castView(eye, 2 * eye, {64, 64, 32, 32, 31.5, 31.5, {}},
                                   [](const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
                                     const double b = o.dot(d);
                                     return -b + std::sqrt(b * b - o.squaredNorm() + 1);
                                   }));
  }
  test::addNoise(views, {0.004, 0, 0}, 2);
  const Reconstruction result = run(views);
  EXPECT_EQ(result.cut->border, Border::Solid);
  EXPECT_TRUE(isClosedManifold(topology(result.mesh)));
  EXPECT_NEAR(signedVolume(result.mesh) / (-4.0 / 3 * M_PI), 1, 0.05);  // the inside is a hole in matter
}

TEST(Reconstruct, OneWildDepthDoesNotGrowTheDomain) {
  const Box expected = run(noisySphere()).grid.domain;
  std::vector<View> views = noisySphere();
  views[2].map.depth(0, 0) = 1e5f;
  const Box found = run(views).grid.domain;
  EXPECT_LT((found.min() - expected.min()).norm() + (found.max() - expected.max()).norm(), 0.03);
}

TEST(Reconstruct, DepthsThatAreNotNumbersAreMissing) {
  std::vector<View> broken = noisySphere(), missing = noisySphere();
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -1.0f};
  for (std::size_t i = 0; i < broken.size(); ++i)
    for (int k = 0; k < 300; ++k) {
      const int x = 20 + k % 25, y = 20 + k / 25;
      if ((k + static_cast<int>(i)) % 3 == 0)
        broken[i].map.depth(x, y) = bad[k % 9 / 3], missing[i].map.depth(x, y) = kInvalidDepth;
    }
  EXPECT_EQ(run(broken).mesh.vertices, run(missing).mesh.vertices);
}

TEST(Reconstruct, SaysWhyItCannot) {
  EXPECT_EQ(messageOf<InvalidArgument>([] { run({}); }), "views: there are none");
  std::vector<View> empty = noisySphere(3);
  for (View& view : empty) view.map.depth = Image<float>(64, 64, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(messageOf<InvalidArgument>([&] { run(empty); }), "views: no view has a valid depth");
  std::vector<View> nowhere = noisySphere(3);
  nowhere[1].name = "b", nowhere[1].world_from_camera.translation().z() = NAN;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { run(nowhere); }), "view b: the pose is not a rigid transform");
  ReconstructOptions options = coarse();
  options.voxel = 0.1;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { run(noisySphere(3), options); }),
            "options: voxel and resolution exclude each other");
}

TEST(Reconstruct, ViewsThatDoNotOverlapAreAnErrorNotAMesh) {
  std::vector<View> apart = noisySphere(4);
  for (std::size_t i = 0; i < apart.size(); ++i)
    apart[i].world_from_camera.translation().x() += 50 * static_cast<double>(i);
  const std::string message = messageOf<InvalidArgument>([&] { run(apart); });
  EXPECT_THAT(message, testing::AnyOf(HasSubstr("do not overlap"), HasSubstr("no depth is believed")));
}

TEST(Reconstruct, ADomainWhereNothingIsGivesAnErrorNotAnEmptyMesh) {
  ReconstructOptions options;
  options.voxel = 0.05;
  options.domain = Box(Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(6, 6, 6));
  EXPECT_THAT(messageOf<Error>([&] { run(noisySphere(6), options); }), HasSubstr("the result is empty"));
}

TEST(Reconstruct, KeepsTheGridsUnderTheirNames) {
  ReconstructOptions options = coarse();
  options.grids = ReconstructOptions::Grids::Keep;
  std::set<std::string> names;
  for (const ScalarGrid& grid : run(noisySphere(), options).grids) names.insert(grid.name());
  for (const char* name : {"surface", "rho", "sigma", "support"}) EXPECT_TRUE(names.contains(name)) << name;
  options.method = Method::Tsdf;
  names.clear();
  for (const ScalarGrid& grid : run(noisySphere(), options).grids) names.insert(grid.name());
  EXPECT_EQ(names, (std::set<std::string>{"surface", "weight"}));
  EXPECT_TRUE(run(noisySphere()).grids.empty());
}

TEST(Reconstruct, CanBeStoppedInEveryStep) {
  std::set<std::string> steps;
  const ViewSequence views = ViewSequence::fromViews(noisySphere(8));
  reconstruct(views, coarse(), Progress([&](std::string_view step, double) {
                steps.insert(std::string(step));
                return true;
              }));
  EXPECT_GE(steps.size(), 8u);
  for (const std::string& name : steps)
    EXPECT_THROW(
        reconstruct(views, coarse(), Progress([&](std::string_view step, double) { return step != name; })),
        Cancelled)
        << name;
}

TEST(Reconstruct, TwelveCleanViewsWithNothingBehindAreNotEmpty) {
  const Reconstruction result = run(test::sphereViews(12, 64));
  const TopologyReport report = topology(result.mesh);
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.components, 1u);
  EXPECT_NEAR(signedVolume(result.mesh) / (4.0 / 3 * M_PI * 0.125), 1, 0.05);
}

TEST(Reconstruct, SolidSmallerThanTheWindowOfADepthIsNotBelieved) {
  const std::vector<View> views = test::sphereViews(12, 64);
  ReconstructOptions options = coarse();
  const Reconstruction all = run(views, options);
  const double volume = signedVolume(all.mesh);
  options.window_px = static_cast<int>(0.8 * std::cbrt(volume) / all.calibration.point_spacing);
  EXPECT_EQ(run(views, options).mesh.triangles, all.mesh.triangles);
  options.window_px = 2 * options.window_px;
  EXPECT_THAT(messageOf<Error>([&] { run(views, options); }), HasSubstr("the result is empty"));
}

TEST(ReconstructOptions, EverythingThatIsWrongIsReported) {
  ReconstructOptions options;
  EXPECT_TRUE(validate(options).empty());
  options.voxel = -1, options.resolution = -1, options.domain = Box(), options.max_level = 7;
  options.noise_scale = NAN, options.outliers = 1.0, options.mu = -1, options.smoothing_voxels = 3;
  options.least_cost = 1.5, options.tsdf.truncation = -1, options.evidence.visibility_prior = 0,
  options.visibility_prior = 0, options.window_px = -1;
  EXPECT_EQ(validate(options).size(), 14u);
}

}  // namespace
}  // namespace vdbfuse
