// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/closest_point.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>

#include "mesh/shapes.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

Vector3d corner(const TriangleMesh& mesh, const Triangle& t, std::size_t k) {
  return mesh.vertices[t[k]].cast<double>();
}

double bruteForce(const TriangleMesh& mesh, const Vector3d& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Vector3d q = closestPointOnTriangle(p, corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2));
    best = std::min(best, (q - p).norm());
  }
  return best;
}

Vector3d randomPoint(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

// Triangles of all sizes and shapes, also needles and points.
TriangleMesh soup(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Vector3d a = randomPoint(random, 1);
    const Vector3d b = a + randomPoint(random, std::pow(10.0, random.uniform(-4, 0.5)));
    const Vector3d c =
        i % 10 == 0 ? b : Vector3d(a + randomPoint(random, std::pow(10.0, random.uniform(-4, 0.5))));
    for (const Vector3d& v : {a, b, c}) mesh.vertices.push_back(v.cast<float>());
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

void expectSameAsBruteForce(const TriangleMesh& mesh, double size) {
  const ClosestPoint closest(mesh);
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p = randomPoint(random, size);
    const SurfacePoint found = closest.query(p);
    EXPECT_DOUBLE_EQ(found.distance, bruteForce(mesh, p));
    EXPECT_DOUBLE_EQ((found.point - p).norm(), found.distance);
    const Triangle& t = mesh.triangles[found.triangle];
    const Vector3d on =
        closestPointOnTriangle(found.point, corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2));
    EXPECT_LT((on - found.point).norm(), 1e-12 * size);
  }
}

TEST(ClosestPoint, AgreesWithBruteForceOnATorus) { expectSameAsBruteForce(test::torus(), 2); }

TEST(ClosestPoint, AgreesWithBruteForceOnABoxOfTwelveLargeTriangles) {
  expectSameAsBruteForce(test::box({0, 0, 0}, {1, 100, 1}), 120);
}

TEST(ClosestPoint, AgreesWithBruteForceOnTrianglesOfAllSizes) {
  for (const std::uint64_t seed : {1, 2, 3}) expectSameAsBruteForce(soup(seed), 3);
}

TEST(ClosestPoint, AgreesWithBruteForceFarAway) { expectSameAsBruteForce(test::sphere(1.0, 3), 1e5); }

TEST(ClosestPoint, APointOnTheSurfaceHasDistanceZero) {
  const TriangleMesh mesh = test::sphere();
  const ClosestPoint closest(mesh);
  for (const Eigen::Vector3f& v : mesh.vertices) EXPECT_EQ(closest.query(v.cast<double>()).distance, 0.0);
}

TEST(ClosestPoint, TheSurfaceOfAnEmptyMeshIsInfinitelyFar) {
  EXPECT_EQ(ClosestPoint({}).query(Vector3d::Zero()).distance, std::numeric_limits<double>::infinity());
}

TEST(ClosestPoint, TrianglesThatAreNotFiniteAreIgnored) {
  TriangleMesh mesh = test::joined(test::octahedron(), test::sphere(1.0, 0, {9, 0, 0}));
  mesh.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
  const SurfacePoint found = ClosestPoint(mesh).query({9, 0, 3});
  EXPECT_DOUBLE_EQ(found.distance, 2.0);
  EXPECT_GE(found.triangle, 8u);
}

TEST(ClosestPoint, ThreadsMayAskAtTheSameTime) {
  const TriangleMesh mesh = test::torus();
  const ClosestPoint closest(mesh);
  std::atomic<int> wrong = 0;
  parallelFor(200, 1, [&](std::size_t i, std::size_t) {
    Random random(5, i);
    const Vector3d p = randomPoint(random, 2);
    if (std::abs(closest.query(p).distance - bruteForce(mesh, p)) > 1e-12) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
}

TEST(ClosestPointOnTriangle, FindsFaceEdgesCornersAndTheRestOfATriangleWithoutArea) {
  const Vector3d a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
  EXPECT_EQ(closestPointOnTriangle({0.5, 0.5, 3}, a, b, c), Vector3d(0.5, 0.5, 0));
  EXPECT_EQ(closestPointOnTriangle({1, -1, 1}, a, b, c), Vector3d(1, 0, 0));
  EXPECT_EQ(closestPointOnTriangle({2, 2, 0}, a, b, c), Vector3d(1, 1, 0));
  EXPECT_EQ(closestPointOnTriangle({-1, -1, 0}, a, b, c), a);
  EXPECT_EQ(closestPointOnTriangle({1, 5, 0}, a, b, b), Vector3d(1, 0, 0));
  EXPECT_EQ(closestPointOnTriangle({1, 5, 0}, b, b, b), b);
}

TEST(ClosestPoint, DistancesOfVerticesAreThoseOfTheirPoints) {
  const TriangleMesh sphere = test::sphere(1.0, 3), larger = test::sphere(1.5, 3);
  const ClosestPoint surface(sphere);
  const std::vector<float> distances = vertexDistances(larger, surface);
  ASSERT_EQ(distances.size(), larger.vertices.size());
  for (std::size_t i = 0; i < distances.size(); ++i)
    EXPECT_FLOAT_EQ(distances[i],
                    static_cast<float>(surface.query(larger.vertices[i].cast<double>()).distance));
  EXPECT_TRUE(vertexDistances({}, surface).empty());
}

TEST(TriangleMesh, AreasOfVerticesSumToTheArea) {
  TriangleMesh mesh = test::sphere(1.0, 3);
  mesh.vertices.emplace_back(9, 9, 9);  // of no triangle
  double sum = 0;
  for (const double a : vertexAreas(mesh)) sum += a;
  EXPECT_NEAR(sum, area(mesh), 1e-9);
  EXPECT_EQ(vertexAreas(mesh).back(), 0);
}

}  // namespace
}  // namespace vdbfuse
