// SPDX-License-Identifier: Apache-2.0
// The same results however little memory there is, and a refusal where there is too little.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "fusion/scenes.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using testing::HasSubstr;

constexpr std::size_t kGiB = std::size_t{1} << 30;

ViewSequence noisySphere(int size = 64) {
  std::vector<View> views = test::sphereViews(24, size);
  test::addNoise(views, {0.004, 0, 0}, 6);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].name = "view" + std::to_string(i);
    views[i].map.confidence = Image<float>(size, size, 0.5f);
    for (int k = 0; k < size; ++k)
      views[i].map.depth(k, k) = 1.2f, views[i].map.confidence(k, k) = 0.1f;  // mistakes
  }
  return ViewSequence::fromViews(std::move(views));
}

ReconstructOptions coarse(Method method = Method::Visibility) {
  ReconstructOptions options;
  options.resolution = 40;
  options.method = method;
  return options;
}

// Three views at a time, not one more.
ScanPlan threeViewsAtATime(const ViewSequence& views) {
  ScanPlan plan = planJudging(views);
  plan.window_bytes = 3 * 64 * 64 * 13;
  return plan;
}

class InAFile : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Methods, InAFile, testing::Values(Method::Visibility, Method::Tsdf));

TEST_P(InAFile, ViewsThatPassByGiveTheSameMeshToTheLastBit) {
  const ViewSequence views = noisySphere();
  const ReconstructOptions options = coarse(GetParam());
  JudgedScan kept = judgeScan(views, options);
  JudgedScan passing = judgeScan(views, options, threeViewsAtATime(views));
  ASSERT_EQ(kept.memory, nullptr);
  ASSERT_NE(passing.memory, nullptr);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(passing.judgement.judged.views[i].memory(), passing.memory.get());
    EXPECT_EQ(passing.judgement.judged.views[i].outlier.memory(), passing.memory.get());
    EXPECT_EQ(passing.judgement.judged.views[i].incidence.memory(), passing.memory.get());
    EXPECT_EQ(passing.judgement.judged.views[i].look.memory(), passing.memory.get());
    EXPECT_EQ(passing.judgement.judged.views[i].outlier, kept.judgement.judged.views[i].outlier);
  }
  const TriangleMesh one = reconstruct(std::move(kept), options).mesh;
  const TriangleMesh other = reconstruct(std::move(passing), options).mesh;
  ASSERT_FALSE(one.triangles.empty());
  EXPECT_EQ(one.vertices, other.vertices);
  EXPECT_EQ(one.triangles, other.triangles);
}

TEST(InAFile, AJudgementThatIsReadBackPassesByAsWell) {
  const test::TemporaryFolder folder;
  const ViewSequence views = noisySphere();
  writeJudgement(folder / ".", judgeScan(views, coarse()), {"1", "in", "test"});
  const TriangleMesh one = reconstruct(readJudgement(folder / ".", views), coarse()).mesh;
  JudgedScan passing = readJudgement(folder / ".", views, threeViewsAtATime(views));
  EXPECT_NE(passing.memory, nullptr);
  EXPECT_EQ(reconstruct(std::move(passing), coarse()).mesh.vertices, one.vertices);
}

TEST(Plan, KnowsTheSceneBeforeTheWorkBegins) {
  const ScanPlan plan = planReconstruction(noisySphere(128), coarse());
  ASSERT_TRUE(plan.survey);
  const double area = 4 * M_PI * 0.25;
  EXPECT_NEAR(plan.survey->area / area, 1, 0.25);
  EXPECT_NEAR(plan.survey->noise_scale, 0.004, 0.002);
  EXPECT_NEAR(plan.survey->median_depth, 1.6, 0.1);
  const Reconstruction result = reconstruct(noisySphere(128), coarse());
  EXPECT_NEAR(plan.voxel / result.grid.voxel, 1, 0.1);
  EXPECT_NEAR(plan.cells / static_cast<double>(result.grid.cells), 1, 0.35);
  EXPECT_EQ(result.memory.estimated, plan.estimated_memory);
}

TEST(Plan, WhatDoesNotFitIsRefusedWithAVoxelThatDoes) {
  ReconstructOptions options;
  options.voxel = 1e-5;
  options.memory = 2 * kGiB;
  const ViewSequence views = noisySphere();
  const std::string message = messageOf<InvalidArgument>([&] { planReconstruction(views, options); });
  EXPECT_THAT(message, HasSubstr("voxel"));
  EXPECT_THAT(message, HasSubstr("2 GiB may be used"));
  std::smatch found;
  ASSERT_TRUE(std::regex_search(message, found, std::regex("; ([0-9.e-]+) would fit"))) << message;
  options.voxel = std::stod(found[1]);
  EXPECT_LE(planReconstruction(views, options).estimated_memory, options.memory);
  // Not much larger than it must be.
  options.voxel *= 0.85;
  EXPECT_THROW(planReconstruction(views, options), InvalidArgument);
  EXPECT_THROW(reconstruct(views, options), InvalidArgument);
}

TEST(Plan, ViewsThatDoNotFitPassBy) {
  std::vector<ViewHeader> headers(1000);
  for (ViewHeader& header : headers) header.projection = test::cameraFor(1000, 0.5, 2);
  const ViewSequence views(headers, [](std::size_t) -> DepthMap { throw Error("must not be loaded"); });
  ReconstructOptions options;
  options.memory = 64 * kGiB;
  EXPECT_EQ(planJudging(views, options).window_bytes, 0u);
  options.memory = 2 * kGiB;
  const ScanPlan plan = planJudging(views, options);
  EXPECT_GT(plan.window_bytes, kGiB);
  EXPECT_LE(plan.estimated_memory, options.memory);
  options.memory = kGiB / 8;
  EXPECT_THAT(messageOf<InvalidArgument>([&] { planJudging(views, options); }),
              testing::AllOf(HasSubstr("memory"), HasSubstr("128 MiB may be used")));
}

TEST(Plan, PixelsMuchFinerThanTheVoxelsAreTakenTogether) {
  const ViewSequence views = noisySphere(256);  // pixels of 0.0034
  ReconstructOptions options;
  options.voxel = 0.03;
  const ScanPlan plan = planReconstruction(views, options);
  for (const int factor : plan.reduction) EXPECT_EQ(factor, 4);
  const JudgedScan scan = judgeScan(views, options, plan);
  EXPECT_EQ(scan.judgement.judged.views[0].depth.width(), 64);
  EXPECT_EQ(scan.width, 256u);
  const TriangleMesh mesh = reconstruct(views, options).mesh;
  EXPECT_TRUE(isClosedManifold(topology(mesh)));
  for (const Eigen::Vector3f& v : mesh.vertices) ASSERT_NEAR(v.norm(), 0.5, 0.03);
  options.voxel = 0.006;
  for (const int factor : planReconstruction(views, options).reduction) EXPECT_EQ(factor, 1);
}

}  // namespace
}  // namespace vdbfuse
