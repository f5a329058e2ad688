// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

Vector3d corner(const TriangleMesh& mesh, const RayHit& hit, int i) {
  return mesh.vertices[mesh.triangles[hit.triangle][i]].cast<double>();
}

struct RandomRay {
  Vector3d origin, direction;
  explicit RandomRay(Random& random) {
    for (int a = 0; a < 3; ++a) origin[a] = random.uniform(-3, 3), direction[a] = random.normal();
  }
};

TEST(RayCaster, FindsTheFaceOfABox) {
  const RayCaster caster(test::box({-1, -1, -1}, {1, 1, 1}));
  const auto hit = caster.cast({0.3, 0.2, -5}, {0, 0, 2});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 2, 1e-6);  // in lengths of the direction
}

TEST(RayCaster, SeesTheInnerSideToo) {
  const RayCaster caster(test::box({-1, -1, -1}, {1, 1, 1}));
  const auto hit = caster.cast({0, 0.1, 0.2}, {1, 0, 0});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 1, 1e-6);
}

TEST(RayCaster, FindsNothingBesideOrBehind) {
  const RayCaster caster(test::box({-1, -1, -1}, {1, 1, 1}));
  EXPECT_FALSE(caster.cast({0, 0, -5}, {0, 0, -1}));
  EXPECT_FALSE(caster.cast({1.5, 0, -5}, {0, 0, 1}));
}

TEST(RayCaster, TheCornersOfTheTriangleGiveThePointOfTheHit) {
  const TriangleMesh mesh = test::sphere(1.0, 3);
  const RayCaster caster(mesh);
  Random random(1);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const RandomRay ray(random);
    const auto hit = caster.cast(ray.origin, ray.direction);
    if (!hit) continue;
    ++hits;
    const Vector3d point = ray.origin + hit->distance * ray.direction;
    const Vector3d from_corners = (1 - hit->u - hit->v) * corner(mesh, *hit, 0) +
                                  hit->u * corner(mesh, *hit, 1) + hit->v * corner(mesh, *hit, 2);
    EXPECT_LT((point - from_corners).norm(), 1e-5);
  }
  EXPECT_GT(hits, 50);
}

TEST(RayCaster, AFineSphereIsMetWhereTheFormulaSays) {
  const RayCaster caster(test::sphere(1.0, 6));
  Random random(2);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const RandomRay ray(random);
    const double a = ray.direction.squaredNorm(), b = ray.origin.dot(ray.direction);
    const double under_root = b * b - a * (ray.origin.squaredNorm() - 1);
    const double near = (-b - std::sqrt(std::max(0.0, under_root))) / a;
    if (under_root / a < 0.1 || near < 0) continue;
    const auto hit = caster.cast(ray.origin, ray.direction);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance * std::sqrt(a), near * std::sqrt(a), 2e-3);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

TEST(RayCaster, NoRayEscapesThroughTheEdgesOfAClosedMesh) {
  const TriangleMesh mesh = test::sphere(1.0, 3);
  const RayCaster caster(mesh);
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    EXPECT_TRUE(caster.cast({0, 0, 0}, vertex.cast<double>()));
}

TEST(RayCaster, GivesTheSameHitsForOneThreadAndTwo) {
  const auto castAll = [](int threads) {
    const ThreadLimit limit(threads);
    const TriangleMesh mesh = test::sphere(1.0, 4);
    const RayCaster caster(mesh);
    std::vector<std::uint32_t> triangles;
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      triangles.push_back(caster.cast({0, 0, 0}, vertex.cast<double>())->triangle);
    return triangles;
  };
  EXPECT_EQ(castAll(1), castAll(2));
}

TEST(RayCaster, AMeshWithoutTrianglesIsNeverMet) {
  EXPECT_FALSE(RayCaster(TriangleMesh{}).cast({0, 0, 0}, {0, 0, 1}));
}

TEST(RayCaster, ATriangleThatNamesAMissingVertexIsRefused) {
  TriangleMesh mesh = test::octahedron();
  mesh.triangles[5][1] = 99;
  try {
    const RayCaster caster(mesh);
    FAIL() << "accepted";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "mesh: triangle 5 names a vertex that is not there");
  }
}

}  // namespace
}  // namespace vdbfuse
