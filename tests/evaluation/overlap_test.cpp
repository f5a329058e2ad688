// SPDX-License-Identifier: Apache-2.0
#include "evaluation/overlap.h"

#include <gtest/gtest.h>

#include <limits>

#include "mesh/shapes.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

// What a grid of single points says, without any shortcut.
double bruteForce(const WindingNumber& a, const WindingNumber& b, const Box& box, int resolution) {
  std::size_t both = 0, any = 0;
  for (int i = 0; i < resolution * resolution * resolution; ++i) {
    const Eigen::Array3d cell(i % resolution, i / resolution % resolution, i / resolution / resolution);
    const Eigen::Vector3d p = box.min().array() + box.sizes().array() * (cell + 0.5) / resolution;
    const bool in_a = a.inside(p), in_b = b.inside(p);
    both += in_a && in_b;
    any += in_a || in_b;
  }
  return static_cast<double>(both) / static_cast<double>(any);
}

struct BruteForce {
  double accuracy;
  int resolution;
};

void expectSameAsBruteForce(const TriangleMesh& mesh, const TriangleMesh& truth, const BruteForce& brute) {
  const WindingNumber mesh_winding(mesh, {.accuracy = brute.accuracy}),
      truth_winding(truth, {.accuracy = brute.accuracy});
  const ClosestPoint mesh_surface(mesh), truth_surface(truth);
  const Solid a{mesh_winding, mesh_surface, finiteBox(mesh), isClosedManifold(topology(mesh))};
  const Solid b{truth_winding, truth_surface, finiteBox(truth), isClosedManifold(topology(truth))};
  const double expected = bruteForce(mesh_winding, truth_winding, a.box.merged(b.box), brute.resolution);
  EXPECT_NEAR(*overlap(a, b, {64, 1}).iou, expected, 0.006);
}

TEST(Overlap, BlocksDecideAsSinglePointsDoForClosedMeshes) {
  const TriangleMesh torus = test::torus(1.0, 0.3, 24, 12);
  expectSameAsBruteForce(test::torus(1.0, 0.35, 24, 12), torus, {2.0, 48});
  expectSameAsBruteForce(test::sphere(0.5, 2, {1, 0, 0}), torus, {2.0, 48});
}

TEST(Overlap, BlocksDecideAsSinglePointsDoForOpenMeshes) {
  const TriangleMesh sphere = test::sphere(1.0, 3), bowl = test::upperHalf(sphere);
  expectSameAsBruteForce(bowl, sphere, {3.0, 32});
  expectSameAsBruteForce(test::sphere(0.5, 2), bowl, {3.0, 32});
}

TEST(Overlap, TheBoxOfAMeshLeavesOutWhatIsNotFiniteOrNotUsed) {
  TriangleMesh mesh = test::octahedron();
  mesh.vertices.push_back({100, 100, 100});
  mesh.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(finiteBox(mesh).max(), Eigen::Vector3d(0, 1, 1));
  EXPECT_TRUE(finiteBox({}).isEmpty());
}

}  // namespace
}  // namespace vdbfuse
