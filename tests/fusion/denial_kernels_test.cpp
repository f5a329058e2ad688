// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

constexpr int kBrick = BrickedEvidence::kBrick;
constexpr float kMost = 2.0f;

// A grid of 24 × 16 × 8 points.
struct Field {
  static constexpr int kX = 24, kY = 16, kZ = 8;

  // `value`: of a point.
  template <class Value>
  explicit Field(const Value& value) : values(kX * kY * kZ), smallest(values.size() / 64, 1e9f) {
    for (int z = 0; z < kZ; ++z) {
      for (int y = 0; y < kY; ++y) {
        for (int x = 0; x < kX; ++x) {
          const std::size_t place = placeOf(x, y, z);
          values[place] = value(x, y, z);
          float& least =
              smallest[place / 512 * 8 + static_cast<std::size_t>(z / 4 % 2 * 4 + y / 4 % 2 * 2 + x / 4 % 2)];
          least = std::min(least, values[place]);
        }
      }
    }
  }

  static std::size_t placeOf(int x, int y, int z) {
    const int brick = (z / kBrick * (kY / kBrick) + y / kBrick) * (kX / kBrick) + x / kBrick;
    return static_cast<std::size_t>(brick * 512 + (z % kBrick * kBrick + y % kBrick) * kBrick + x % kBrick);
  }
  BrickedEvidence evidence() const { return {values.data(), smallest.data(), {kX, kY, kZ}}; }

  std::vector<float> values, smallest;
};

struct Ray {
  Eigen::Vector3d start, way;
  double safe = 0;
};

float smallestOn(const Field& field, const std::vector<Ray>& rays, std::size_t which) {
  RayBatch batch;
  for (const Ray& ray : rays) {
    for (std::size_t a = 0; a < 3; ++a) {
      batch.start[a][batch.size] = static_cast<float>(ray.start[static_cast<Eigen::Index>(a)]);
      batch.way[a][batch.size] = static_cast<float>(ray.way[static_cast<Eigen::Index>(a)]);
    }
    batch.safe[batch.size++] = static_cast<float>(ray.safe);
  }
  findSmallest(field.evidence(), kMost, batch);
  return batch.smallest[which];
}

float smallestOn(const Field& field, const Ray& ray) { return smallestOn(field, {ray}, 0); }

TEST(DenialKernels, ARayAlongAnAxisMeetsExactlyItsPoints) {
  Random random(3);
  const Field field([&](int, int, int) { return static_cast<float>(random.uniform(-5, 20)); });
  for (const auto& [from, to] : {std::pair{0, 23}, {0, 5}, {7, 9}, {20, 23}}) {
    float along = kMost, back = kMost;
    for (int x = from; x <= to; ++x) along = std::min(along, field.values[Field::placeOf(x, 6, 3)]);
    back = along;
    const Eigen::Vector3d way(to - from, 0, 0);
    EXPECT_EQ(smallestOn(field, {{from + 0.5, 6.5, 3.5}, way}), along) << from << " " << to;
    EXPECT_EQ(smallestOn(field, {{to + 0.5, 6.5, 3.5}, -way}), back) << from << " " << to;
  }
}

TEST(DenialKernels, OctantsThatSayNothingAreSteppedOver) {
  // Eight points around (14, 9, 5), so that no step passes over them.
  const Field field([](int x, int y, int z) {
    return (x == 13 || x == 14) && (y == 8 || y == 9) && (z == 4 || z == 5) ? -1.0f : 10.0f;
  });
  for (const Eigen::Vector3d& start :
       {Eigen::Vector3d(-5, -3, -20), {40, 20, 5.5}, {14.5, 9.5, 30}, {2, 30, 1}}) {
    const Eigen::Vector3d way = 1.05 * (Eigen::Vector3d(14, 9, 5) - start);
    EXPECT_EQ(smallestOn(field, {start, way}), -1.0f) << start.transpose();
    EXPECT_EQ(smallestOn(field, {start, 0.8 * way}), kMost) << start.transpose();  // ends before them
    EXPECT_EQ(smallestOn(field, {start, way, 0.85}), -1.0f) << start.transpose();
    EXPECT_EQ(smallestOn(field, {start, 1.5 * way, 0.85}), kMost) << start.transpose();  // begins behind them
  }
}

// Steps of one along any ray; the field changes little from point to point, so that which of two points is
// nearer to a step does not matter.
TEST(DenialKernels, AnyRayMeetsTheSmallestOfItsSteps) {
  const auto at = [](const Eigen::Vector3d& p) {
    return std::sin(0.3 * p.x()) + std::cos(0.4 * p.y() + 0.2 * p.z());
  };
  const Field field([&](int x, int y, int z) {
    return static_cast<float>(at(Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5)));
  });
  Random random(6);
  const auto anywhere = [&] {
    return Eigen::Vector3d(random.uniform(-20, 44), random.uniform(-20, 36), random.uniform(-20, 28));
  };
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < RayBatch::kCapacity; ++i) {
    const Eigen::Vector3d start = anywhere();
    rays.push_back({start, anywhere() - start});
  }
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double length = rays[i].way.norm();
    double expected = kMost;
    for (double s = 0; s <= length; s += 0.25) {
      const Eigen::Vector3d p = rays[i].start + s / length * rays[i].way;
      if ((p.array() < 0).any() || p.x() > Field::kX || p.y() > Field::kY || p.z() > Field::kZ) continue;
      expected = std::min(expected, at(p));
    }
    met += expected < kMost;
    EXPECT_NEAR(smallestOn(field, rays, i), expected, 0.6) << i;
  }
  EXPECT_GT(met, 15);
}

TEST(DenialKernels, ARayThatMissesTheGridOrGoesNowhereMeetsNothing) {
  const Field field([](int, int, int) { return -1.0f; });
  EXPECT_EQ(smallestOn(field, {{-5, 5, 5}, {0, 3, 0}}), kMost);
  EXPECT_EQ(smallestOn(field, {{-5, 5, 5}, {-3, 0, 0}}), kMost);
  EXPECT_EQ(smallestOn(field, {{30, 5, 5}, {3, 0, 0}}), kMost);
  EXPECT_EQ(smallestOn(field, {{-5, 5, 5}, {0, 0, 0}}), kMost);
  EXPECT_EQ(smallestOn(field, {{5, 5, 5}, {0, 0, 0}}), -1.0f);
}

}  // namespace
}  // namespace vdbfuse
