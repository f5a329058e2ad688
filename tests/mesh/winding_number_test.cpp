// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/winding_number.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

double bruteForce(const TriangleMesh& mesh, const Vector3d& p) {
  double angle = 0;
  for (const Triangle& t : mesh.triangles) {
    angle += solidAngle(p, mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
                        mesh.vertices[t[2]].cast<double>());
  }
  return angle / (4 * std::numbers::pi);
}

void expectNearBruteForce(const TriangleMesh& mesh, double accuracy, double tolerance) {
  const WindingNumber winding(mesh, {.accuracy = accuracy});
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
    EXPECT_NEAR(winding.at(p), bruteForce(mesh, p), tolerance) << p.transpose();
  }
}

TEST(SolidAngle, AnOctantOfTheSphereIsHalfPi) {
  EXPECT_NEAR(solidAngle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(solidAngle({0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}), -std::numbers::pi / 2, 1e-12);
}

TEST(WindingNumber, AgreesWithTheSumOfAllSolidAngles) {
  for (const TriangleMesh& mesh :
       {test::sphere(1.0, 4), test::torus(), test::upperHalf(test::sphere(1.0, 4))}) {
    expectNearBruteForce(mesh, 2, 0.1);
    expectNearBruteForce(mesh, 8, 0.005);
  }
}

TEST(WindingNumber, IsOneInsideAndZeroOutsideOfAClosedMesh) {
  const TriangleMesh mesh = test::torus(1.0, 0.3, 96, 48);
  const WindingNumber winding(mesh);
  Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const Vector3d p(random.uniform(-1.4, 1.4), random.uniform(-1.4, 1.4), random.uniform(-0.4, 0.4));
    const double to_tube = std::hypot(std::hypot(p.x(), p.y()) - 1.0, p.z());
    if (std::abs(to_tube - 0.3) < 0.01) continue;
    EXPECT_EQ(winding.inside(p), to_tube < 0.3) << p.transpose();
  }
}

TEST(WindingNumber, IsMinusOneInsideOfAMeshThatIsInsideOut) {
  const WindingNumber winding(test::inverted(test::sphere()));
  EXPECT_NEAR(winding.at({0.2, 0.1, -0.3}), -1.0, 0.05);
  EXPECT_NEAR(winding.at({2, 0, 0}), 0.0, 0.05);
}

TEST(WindingNumber, IsOneHalfAtTheCentreOfAnOpenHemisphere) {
  const WindingNumber winding(test::upperHalf(test::sphere(1.0, 5)));
  EXPECT_NEAR(winding.at({0, 0, 0}), 0.5, 0.05);
  EXPECT_TRUE(winding.inside({0, 0, 0.5}));
  EXPECT_FALSE(winding.inside({0, 0, -0.5}));
}

TEST(WindingNumber, HigherAccuracyComesCloser) {
  const TriangleMesh mesh = test::upperHalf(test::sphere(1.0, 4));
  const WindingNumber rough(mesh, {.accuracy = 1.5}), fine(mesh, {.accuracy = 8});
  Random random(2);
  double rough_error = 0, fine_error = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
    rough_error = std::max(rough_error, std::abs(rough.at(p) - bruteForce(mesh, p)));
    fine_error = std::max(fine_error, std::abs(fine.at(p) - bruteForce(mesh, p)));
  }
  EXPECT_LT(fine_error, 0.25 * rough_error);
}

TEST(WindingNumber, AnEmptyMeshHasNoInside) { EXPECT_EQ(WindingNumber({}).at({0, 0, 0}), 0.0); }

TEST(WindingNumber, TrianglesThatAreNotFiniteAreIgnored) {
  TriangleMesh mesh = test::joined(test::sphere(1.0, 2), test::octahedron());
  mesh.vertices.back().z() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isfinite(WindingNumber(mesh).at({0, 0, 0})));
}

TEST(WindingNumber, AnAccuracyThatWouldPutThePointIntoTheFarFieldIsRefused) {
  EXPECT_THROW(WindingNumber(test::octahedron(), {.accuracy = 1}), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
