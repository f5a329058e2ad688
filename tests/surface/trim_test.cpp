// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/trim.h"

#include <gmock/gmock.h>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/simplify.h"

namespace vdbfuse {
namespace {

using testing::HasSubstr;

// A sphere with the height of each vertex as its support, and every other attribute.
TriangleMesh supportedSphere() {
  TriangleMesh mesh = test::sphere(1.0, 4);
  mesh.normals = vertexNormals(mesh);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    mesh.support.push_back(v.z());
    mesh.confidence.push_back(v.x());
    mesh.colors.push_back({static_cast<std::uint8_t>(100 + 100 * v.y()), 0, 0});
  }
  return mesh;
}

void expectAttributesOfTheirVertices(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.support.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    ASSERT_EQ(mesh.support[v], mesh.vertices[v].z());
    ASSERT_EQ(mesh.confidence[v], mesh.vertices[v].x());
    ASSERT_EQ(mesh.colors[v][0], static_cast<std::uint8_t>(100 + 100 * mesh.vertices[v].y()));
    ASSERT_LT((mesh.normals[v] - mesh.vertices[v]).norm(), 0.1);
  }
}

TEST(TrimUnsupported, LeavesWhatIsSupportedWithAnOpenRimAndSaysSo) {
  TriangleMesh mesh = supportedSphere();
  trimUnsupported(0.5f, mesh);
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.components, 1u);
  EXPECT_GT(report.open_edges, 20u);
  EXPECT_EQ(report.nonmanifold_edges + report.nonmanifold_vertices + report.inconsistent_edges, 0u);
  EXPECT_EQ(report.used_vertices, mesh.vertices.size());
  for (const float support : mesh.support) EXPECT_GE(support, 0.5f);
  expectAttributesOfTheirVertices(mesh);
  ASSERT_EQ(mesh.comments.size(), 1u);
  EXPECT_THAT(mesh.comments[0], HasSubstr("open: trimmed where fewer than 0.5 views agree"));
}

TEST(TrimUnsupported, FansThatWouldTouchInAVertexArePartedWithTheirAttributes) {
  TriangleMesh mesh = supportedSphere();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    mesh.support[v] = std::abs(mesh.vertices[v].x() * mesh.vertices[v].y()) < 1e-6f ? 1.0f : 0.0f;
  for (const Triangle& t : mesh.triangles) mesh.support[t[0]] = t[0] % 3 != 0 ? 1.0f : mesh.support[t[0]];
  trimUnsupported(0.5f, mesh);
  const TopologyReport report = topology(mesh);
  EXPECT_GT(report.open_edges, 100u);
  EXPECT_EQ(report.nonmanifold_vertices, 0u);
  EXPECT_EQ(mesh.support.size(), mesh.vertices.size());
  EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
}

TEST(TrimUnsupported, NeedsSupport) {
  TriangleMesh mesh = test::sphere();
  EXPECT_THROW(trimUnsupported(1, mesh), InvalidArgument);
}

TEST(DropSmallComponents, DropsThoseBelowASizeAndNothingElse) {
  TriangleMesh mesh = test::joined(test::sphere(1.0, 2), test::sphere(0.1, 2, {3, 0, 0}));
  mesh = test::joined(mesh, test::sphere(0.2, 2, {0, 3, 0}));
  EXPECT_EQ(dropSmallComponents(0.3, mesh), 0u);
  EXPECT_EQ(dropSmallComponents(0.5, mesh), 1u);
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.components, 2u);
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.used_vertices, mesh.vertices.size());
}

TEST(Simplify, LeavesAboutAsManyTrianglesAsAskedForAndAClosedManifold) {
  for (const TriangleMesh& shape : {supportedSphere(), test::torus(1.0, 0.3, 96)}) {
    TriangleMesh mesh = shape;
    const TopologyReport before = topology(mesh);
    const std::size_t wanted = mesh.triangles.size() / 5;
    const SimplifyReport report = simplify({wanted, 0}, mesh);
    EXPECT_EQ(report.triangles, mesh.triangles.size());
    EXPECT_LE(mesh.triangles.size(), wanted + wanted / 10);
    const TopologyReport after = topology(mesh);
    EXPECT_TRUE(isClosedManifold(after));
    EXPECT_EQ(after.euler_number, before.euler_number);
    EXPECT_LT(report.error, 0.05);
  }
}

TEST(Simplify, KeepsTheAttributesOfTheVerticesThatAreLeft) {
  TriangleMesh mesh = supportedSphere();
  simplify({500, 0}, mesh);
  expectAttributesOfTheirVertices(mesh);
}

TEST(Simplify, FlatPartsNeedNoTrianglesWithinATolerance) {
  TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
  for (int level = 0; level < 4; ++level) mesh = test::subdivided(mesh);
  const std::size_t before = mesh.triangles.size();
  simplify({0, 1e-4}, mesh);
  EXPECT_LT(mesh.triangles.size(), before / 20);
  EXPECT_TRUE(isClosedManifold(topology(mesh)));
  EXPECT_NEAR(signedVolume(mesh), 1, 1e-3);
}

TEST(Simplify, GoesFurtherWhereTheTopologyMayChange) {
  TriangleMesh many;  // spheres that cannot all become smaller than an octahedron and stay
  for (std::uint32_t k = 0; k < 40; ++k) {
    const TriangleMesh sphere = test::sphere(1.0, 1);
    const auto first = static_cast<std::uint32_t>(many.vertices.size());
    for (const Eigen::Vector3f& v : sphere.vertices)
      many.vertices.emplace_back(v + Eigen::Vector3f(3.0f * static_cast<float>(k), 0, 0));
    for (const auto& [a, b, c] : sphere.triangles)
      many.triangles.push_back({a + first, b + first, c + first});
  }
  TriangleMesh kept = many, free = many;
  simplify({80, 0}, kept);
  simplify({80, 0, SimplifyOptions::Topology::MayChange}, free);
  EXPECT_EQ(topology(kept).components, 40u);
  EXPECT_LT(free.triangles.size(), kept.triangles.size());
}

TEST(Simplify, NeedsANumberOrATolerance) {
  TriangleMesh mesh = test::sphere();
  EXPECT_THROW(simplify({}, mesh), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
