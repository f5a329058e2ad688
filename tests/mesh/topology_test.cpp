// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/topology.h"

#include <gtest/gtest.h>

#include <limits>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

TEST(Topology, AClosedSphereIsAClosedManifoldOfEulerNumberTwo) {
  const TopologyReport report = topology(test::sphere(1.0, 3));
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.triangles, 512u);
  EXPECT_EQ(report.edges, 768u);
  EXPECT_EQ(report.euler_number, 2);
  EXPECT_EQ(report.components, 1u);
}

TEST(Topology, ATorusHasEulerNumberZero) {
  const TopologyReport report = topology(test::torus());
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.euler_number, 0);
}

TEST(Topology, ABoxIsClosedInsideOutOrNot) {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
  EXPECT_TRUE(isClosedManifold(topology(box)));
  EXPECT_TRUE(isClosedManifold(topology(test::inverted(box))));
}

TEST(Topology, AMissingTriangleLeavesThreeOpenEdgesAndNoOtherFault) {
  TriangleMesh mesh = test::sphere(1.0, 2);
  mesh.triangles.pop_back();
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.open_edges, 3u);
  EXPECT_EQ(report.nonmanifold_vertices, 0u);
  EXPECT_EQ(report.euler_number, 1);
  EXPECT_FALSE(isClosedManifold(report));
}

TEST(Topology, AFlippedTriangleMakesItsThreeEdgesInconsistent) {
  TriangleMesh mesh = test::sphere(1.0, 2);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.inconsistent_edges, 3u);
  EXPECT_EQ(report.open_edges, 0u);
  EXPECT_FALSE(isClosedManifold(report));
}

TEST(Topology, AFinOnAnEdgeMakesItNonManifold) {
  TriangleMesh mesh = test::octahedron();
  mesh.vertices.push_back({3, 3, 3});
  mesh.triangles.push_back({0, 2, 6});
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.nonmanifold_edges, 1u);
  EXPECT_EQ(report.open_edges, 2u);
  EXPECT_EQ(report.nonmanifold_vertices, 2u);
}

TEST(Topology, TwoSpheresThatShareAVertexAreOneComponentWithOneNonManifoldVertex) {
  TriangleMesh mesh = test::joined(test::octahedron(), test::octahedron());
  for (Triangle& t : mesh.triangles) std::replace(t.begin(), t.end(), 6u, 0u);
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.nonmanifold_vertices, 1u);
  EXPECT_EQ(report.nonmanifold_edges, 0u);
  EXPECT_EQ(report.open_edges, 0u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.used_vertices, 11u);
  EXPECT_FALSE(isClosedManifold(report));
}

TEST(Topology, TwoSpheresApartAreTwoComponents) {
  const TopologyReport report = topology(test::joined(test::octahedron(), test::sphere(1.0, 2, {5, 0, 0})));
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.euler_number, 4);
  EXPECT_TRUE(isClosedManifold(report));
}

TEST(Topology, TwoTrianglesBackToBackAreNotAClosedManifold) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.open_edges, 0u);
  EXPECT_EQ(report.nonmanifold_vertices, 3u);
  EXPECT_FALSE(isClosedManifold(report));
}

TEST(Topology, ATriangleThatNamesAVertexTwiceIsDegenerateAndOtherwiseIgnored) {
  TriangleMesh mesh = test::octahedron();
  mesh.triangles.push_back({0, 0, 2});
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.degenerate_triangles, 1u);
  EXPECT_EQ(report.nonmanifold_edges, 0u);
  EXPECT_FALSE(isClosedManifold(report));
}

TEST(Topology, ATriangleWithoutAreaIsCountedAndAllowed) {
  TriangleMesh mesh = test::octahedron();
  mesh.vertices[0] = mesh.vertices[2];
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.zero_area_triangles, 2u);
  EXPECT_TRUE(isClosedManifold(report));
}

TEST(Topology, AVertexThatIsNotANumberIsCountedAndNotAllowed) {
  TriangleMesh mesh = test::octahedron();
  mesh.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(topology(mesh).nonfinite_vertices, 1u);
  EXPECT_FALSE(isClosedManifold(topology(mesh)));
}

TEST(Topology, AnEmptyMeshIsNotClosed) { EXPECT_FALSE(isClosedManifold(topology({}))); }

TEST(Topology, ATriangleThatNamesAVertexThatDoesNotExistIsRefused) {
  TriangleMesh mesh = test::octahedron();
  mesh.triangles.push_back({0, 1, 6});
  try {
    topology(mesh);
    FAIL() << "nothing was thrown";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "mesh: triangle 8 names vertex 6 of 6");
  }
}

TEST(Topology, OneThreadCountsAsManyDo) {
  const TriangleMesh mesh = test::upperHalf(test::sphere(1.0, 7));
  const TopologyReport many = topology(mesh);
  const ThreadLimit limit(1);
  const TopologyReport one = topology(mesh);
  EXPECT_EQ(one.edges, many.edges);
  EXPECT_EQ(one.open_edges, many.open_edges);
  EXPECT_EQ(one.open_edges, 512u);
}

}  // namespace
}  // namespace vdbfuse
