// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/integrator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "fusion/scenes.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/extract.h"

namespace vdbfuse {
namespace {

IntegratorOptions options() {
  IntegratorOptions o;
  o.voxel = 0.03;
  return o;
}

void expectTheSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v) ASSERT_EQ(a.vertices[v], b.vertices[v]);
  EXPECT_EQ(a.support, b.support);
}

TEST(Integrator, TheMeshIsThatOfTheVolume) {
  const std::vector<View> views = test::sphereViews(20);
  Integrator integrator(options());
  TsdfOptions tsdf;
  tsdf.truncation = 0.12;
  TsdfVolume volume({0.03}, tsdf);
  for (const View& view : views) {
    integrator.integrate(view);
    if (&view == &views[9]) integrator.mesh();
    const Image<float> weights = measurementWeights(view, std::nullopt, 0.03, {});
    volume.integrate({view, view.map.depth, &weights});
  }
  TriangleMesh expected = extractSurface(volume.distance());
  volume.describeVertices(expected);
  expectTheSame(integrator.mesh(), expected);
  EXPECT_GT(expected.triangles.size(), 1000u);
}

TEST(Integrator, MeshesOnlyWhatChanged) {
  Integrator integrator(options());
  for (const View& view : test::sphereViews(30)) integrator.integrate(view);
  integrator.mesh();
  const std::size_t all = integrator.meshedLeaves();
  integrator.mesh();
  EXPECT_EQ(integrator.meshedLeaves(), 0u);
  integrator.integrate(
      test::castView({0, 0, 2}, {0, 0, 0.4}, test::cameraFor(64, 0.2, 1.5), test::sphereCaster(0.5)));
  integrator.mesh();
  EXPECT_GT(integrator.meshedLeaves(), 0u);
  EXPECT_LT(integrator.meshedLeaves(), 2 * all / 3);
}

TEST(Integrator, AnotherThreadMayAskForMeshesAllTheWhile) {
  const std::vector<View> views = test::sphereViews(40);
  Integrator integrator(options()), alone(options());
  std::atomic<bool> done = false;
  std::thread viewer([&] {
    while (!done) {
      const TopologyReport report = topology(integrator.mesh());
      EXPECT_EQ(report.nonmanifold_edges, 0u);
    }
  });
  for (const View& view : views) integrator.integrate(view);
  done = true;
  viewer.join();
  for (const View& view : views) alone.integrate(view);
  expectTheSame(integrator.mesh(), alone.mesh());
}

TEST(Integrator, ChangedBlocksAreThePartsOfTheMesh) {
  IntegratorOptions with_colors = options();
  with_colors.tsdf.colors = TsdfColors::Keep;
  Integrator integrator(with_colors);
  for (View& view : test::sphereViews(10)) {
    view.map.color = Image<Rgb8>(64, 64, {10, 200, 30});
    integrator.integrate(view);
  }
  const TriangleMesh mesh = integrator.mesh();
  std::size_t triangles = 0;
  float most = 0;
  for (const SurfaceBlock& block : integrator.changedBlocks()) {
    triangles += block.mesh.triangles.size();
    ASSERT_EQ(block.mesh.support.size(), block.mesh.vertices.size());
    for (const float support : block.mesh.support) most = std::max(most, support);
    for (const Rgb8& color : block.mesh.colors) ASSERT_NEAR(color[1], 200, 2);
    EXPECT_EQ(block.mesh.colors.size(), block.mesh.vertices.size());
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  EXPECT_EQ(most, *std::max_element(mesh.support.begin(), mesh.support.end()));
  EXPECT_TRUE(integrator.changedBlocks().empty());
}

TEST(Integrator, GoesOnWithAVolumeThatWasWritten) {
  const test::TemporaryFolder folder;
  const std::vector<View> views = test::sphereViews(20);
  Integrator whole(options()), first(options());
  for (std::size_t i = 0; i < views.size(); ++i) {
    whole.integrate(views[i]);
    if (i < 8) first.integrate(views[i]);
  }
  first.write(folder.path() / "part.vdb");
  Integrator rest(TsdfVolume::read(folder.path() / "part.vdb"), options());
  expectTheSame(rest.mesh(), first.mesh());
  for (std::size_t i = 8; i < views.size(); ++i) rest.integrate(views[i]);
  expectTheSame(rest.mesh(), whole.mesh());
}

TEST(Integrator, AViewTakenOutIsGone) {
  const std::vector<View> views = test::sphereViews(2);
  Integrator one(options()), both(options());
  one.integrate(views[1]);
  both.integrate(views[0]), both.integrate(views[1]);
  EXPECT_GT(both.mesh().triangles.size(), 1.5 * static_cast<double>(one.mesh().triangles.size()));
  both.remove(views[0]);
  const TriangleMesh left = both.mesh(), expected = one.mesh();
  EXPECT_EQ(left.triangles.size(), expected.triangles.size());
  ASSERT_EQ(left.support.size(), expected.support.size());
  for (std::size_t v = 0; v < left.support.size(); ++v)
    EXPECT_NEAR(left.support[v], expected.support[v], 1e-4);
}

TEST(Integrator, SaysWhatIsWrong) {
  IntegratorOptions bad;
  bad.least_weight = -1, bad.tsdf.truncation = -1;
  EXPECT_EQ(validate(bad).size(), 3u);
  EXPECT_THROW(Integrator{bad}, InvalidArgument);
  Integrator good(options());
  View view = test::sphereViews(1)[0];
  view.name = "frame 7", view.map.depth = Image<float>(3, 3);
  try {
    good.integrate(view);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("frame 7"));
  }
}

}  // namespace
}  // namespace vdbfuse
