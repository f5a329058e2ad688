// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/compare.h"

#include <gtest/gtest.h>

#include <deque>

#include "fusion/scenes.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using test::messageOf;

ViewSequence scan() {
  std::vector<View> views = test::sphereViews(12, 48);
  test::addNoise(views, {0.004, 0, 0}, 1);
  return ViewSequence::fromViews(std::move(views));
}

ReconstructOptions optionsOf(Method method) {
  ReconstructOptions options;
  options.method = method, options.resolution = 32;
  return options;
}

const std::vector<MethodToCompare> kMethods = {{"cut", optionsOf(Method::Visibility)},
                                               {"average", optionsOf(Method::Tsdf)}};

std::deque<ComparedMethod> compareAll(const std::vector<MethodToCompare>& methods,
                                      const Progress& progress = {}) {
  std::deque<ComparedMethod> all;
  compareMethods(
      judgeScan(scan()), methods, [&](ComparedMethod method) { all.push_back(std::move(method)); }, progress);
  return all;
}

TEST(CompareMethods, EachResultIsThatOfTheMethodAlone) {
  const std::deque<ComparedMethod> all = compareAll(kMethods);
  ASSERT_EQ(all.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(all[k].name, kMethods[k].name);
    const Reconstruction alone = reconstruct(judgeScan(scan()), kMethods[k].options);
    EXPECT_EQ(all[k].result.mesh.vertices, alone.mesh.vertices);
    EXPECT_EQ(all[k].result.mesh.triangles, alone.mesh.triangles);
  }
}

TEST(CompareMethods, AllHaveTheVoxelOfTheFirst) {
  std::vector<MethodToCompare> methods = kMethods;
  methods[1].options.resolution = 0, methods[1].options.voxel = 0.5;
  const std::deque<ComparedMethod> all = compareAll(methods);
  EXPECT_EQ(all[0].result.grid.voxel, all[1].result.grid.voxel);
  EXPECT_EQ(all[1].options.voxel, all[0].result.grid.voxel);
}

TEST(CompareMethods, StepsBeginWithTheJudgement) {
  const std::vector<StepTime> shared = judgeScan(scan()).steps;
  for (const ComparedMethod& method : compareAll(kMethods)) {
    ASSERT_GT(method.result.steps.size(), shared.size());
    for (std::size_t i = 0; i < shared.size(); ++i) EXPECT_EQ(method.result.steps[i].name, shared[i].name);
    EXPECT_GT(method.peak_memory_bytes, 0u);
  }
}

TEST(CompareMethods, ProgressNamesTheMethod) {
  bool named = false;
  const Progress progress([&](std::string_view step, double) {
    named = named || step.starts_with("average: ");
    return true;
  });
  compareAll(kMethods, progress);
  EXPECT_TRUE(named);
}

TEST(CompareMethods, CanBeStopped) {
  const Progress stop([](std::string_view step, double) { return !step.starts_with("average: "); });
  EXPECT_THROW(compareAll(kMethods, stop), Cancelled);
}

TEST(CompareMethods, RefusesBeforeAnyMethodBegins) {
  EXPECT_EQ(messageOf<InvalidArgument>([] { compareAll({}); }), "methods: there are none");
  std::vector<MethodToCompare> methods = kMethods;
  methods[1].options.mu = -1;
  int taken = 0;
  EXPECT_EQ(messageOf<InvalidArgument>(
                [&] { compareMethods(judgeScan(scan()), methods, [&](const ComparedMethod&) { ++taken; }); }),
            "options of average: mu and lambda must not be negative");
  EXPECT_EQ(taken, 0);
}

}  // namespace
}  // namespace vdbfuse
