// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/sampling.h"

#include <gtest/gtest.h>

#include <limits>

#include "mesh/shapes.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mesh/closest_point.h"

namespace vdbfuse {
namespace {

TEST(Sampling, EveryTriangleGetsItsShareOfTheArea) {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
  std::vector<double> hits(box.triangles.size(), 0);
  constexpr std::size_t kCount = 10000;
  for (const SurfaceSample& s : sampleSurface(box, kCount, 1)) ++hits[s.triangle];
  for (std::size_t i = 0; i < hits.size(); ++i) {
    TriangleMesh one = box;
    one.triangles = {box.triangles[i]};
    EXPECT_NEAR(hits[i], kCount * area(one) / area(box), 2.0) << i;
  }
}

TEST(Sampling, PointsLieOnTheirTriangleAndAverageToItsCentre) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 1}, {3, 0, 1}, {0, 3, 1}};
  mesh.triangles = {{0, 1, 2}};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SurfaceSample& s : sampleSurface(mesh, 20000, 3)) {
    const Eigen::Vector3d on = closestPointOnTriangle(s.point, {0, 0, 1}, {3, 0, 1}, {0, 3, 1});
    EXPECT_LT((on - s.point).norm(), 1e-12);
    sum += s.point;
  }
  EXPECT_LT((sum / 20000 - Eigen::Vector3d(1, 1, 1)).norm(), 0.02);
}

TEST(Sampling, TheSeedDecidesAndTheThreadsDoNot) {
  const TriangleMesh mesh = test::torus();
  const auto many = sampleSurface(mesh, 20000, 1), other = sampleSurface(mesh, 20000, 2);
  const ThreadLimit limit(1);
  const auto one = sampleSurface(mesh, 20000, 1);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].point, many[i].point);
    differing += one[i].point != other[i].point;
  }
  EXPECT_EQ(differing, one.size());
}

TEST(Sampling, TrianglesWithoutAFiniteAreaGetNoSample) {
  TriangleMesh mesh = test::octahedron();
  mesh.vertices[0].x() = std::numeric_limits<float>::infinity();
  mesh.triangles.push_back({1, 1, 2});
  for (const SurfaceSample& s : sampleSurface(mesh, 1000, 1)) {
    EXPECT_TRUE(s.point.allFinite());
    EXPECT_NE(s.triangle, 8u);
  }
  mesh.triangles = {{1, 1, 2}};
  EXPECT_TRUE(sampleSurface(mesh, 1000, 1).empty());
  EXPECT_TRUE(sampleSurface({}, 1000, 1).empty());
}

}  // namespace
}  // namespace vdbfuse
