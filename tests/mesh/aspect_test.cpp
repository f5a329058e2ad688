// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/aspect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/shapes.h"

namespace vdbfuse {
namespace {

TEST(Aspects, AreOneForEquilateralTrianglesAndGrowWithSlivers) {
  const AspectReport regular = aspects(test::octahedron());
  EXPECT_NEAR(regular.median, 1, 1e-6);
  EXPECT_NEAR(regular.largest, 1, 1e-6);
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5f, 0.01f, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_NEAR(aspects(mesh).largest, 2 / (4 * std::sqrt(3.0) * 0.005), 0.1);
}

TEST(Aspects, AreInfiniteWithoutAreaAndZeroWithoutTriangles) {
  TriangleMesh mesh;
  EXPECT_EQ(aspects(mesh).largest, 0);
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_TRUE(std::isinf(aspects(mesh).largest));
}

TEST(Aspects, OrderTheQuantiles) {
  TriangleMesh mesh = test::torus();
  const AspectReport report = aspects(mesh);
  EXPECT_GE(report.median, 1 - 1e-6);
  EXPECT_GE(report.quantile99, report.median);
  EXPECT_GE(report.largest, report.quantile99);
}

}  // namespace
}  // namespace vdbfuse
