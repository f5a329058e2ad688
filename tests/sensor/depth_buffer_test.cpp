// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/depth_buffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

const Pinhole kPinhole{5, 4, 6.0, 7.0, 1.9, 1.6, {}};
const Pinhole kDistorted{5, 4, 6.0, 7.0, 1.9, 1.6, {-0.1, 0.02, 0.001, -0.002, 0.0}};
const Spherical kSpherical{5, 4, -0.4, 0.2, -0.3, 0.2};
const Orthographic kOrthographic{5, 4, -1.0, 0.5, -0.5, 0.25};
const PushBroom kPushBroom{5, 4, -0.2, 0.1, 0.5, 6.0, 1.5};
const std::vector<Projection> kAll = {kPinhole, kDistorted, kSpherical, kOrthographic, kPushBroom};

float wanted(int x, int y) { return 1.0f + 0.1f * static_cast<float>(x) + 0.3f * static_cast<float>(y); }

// Stores what `measure` says of each pixel's point, and expects the sensor's depth back.
template <class Measure>
void expectDepthBack(const Projection& projection, const DepthEncoding& encoding, const Measure& measure) {
  Image<float> stored(5, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) {
      const Eigen::Vector3d point = unproject(projection, x, y, wanted(x, y));
      const Eigen::Vector3d start = unproject(projection, x, y, 1e-12);
      stored(x, y) = static_cast<float>(measure(point, start) / encoding.scale);
    }
  }
  const Image<float> depth = toSensorDepth(stored, projection, encoding);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) EXPECT_NEAR(depth(x, y), wanted(x, y), 2e-6f) << projection.index();
  }
}

TEST(ToSensorDepth, DistanceAlongTheAxisIsUnderstoodByEverySensor) {
  for (const Projection& projection : kAll) {
    expectDepthBack(projection, {DepthKind::Z, 0.001, 0},
                    [](const auto& point, const auto&) { return point.z(); });
  }
}

TEST(ToSensorDepth, DistanceAlongTheRayIsUnderstoodByEverySensor) {
  for (const Projection& projection : kAll) {
    expectDepthBack(projection, {DepthKind::Range, 2.0, 0},
                    [](const auto& point, const auto& start) { return (point - start).norm(); });
  }
}

TEST(ToSensorDepth, DisparityIsFocalLengthTimesBaselineOverZ) {
  expectDepthBack(kPinhole, {DepthKind::Disparity, 1.0 / 16, 6.0 * 0.25},
                  [](const auto& point, const auto&) { return 6.0 * 0.25 / point.z(); });
}

TEST(ToSensorDepth, InverseDepthIsOneOverZ) {
  for (const Projection& projection : kAll) {
    expectDepthBack(projection, {DepthKind::Inverse, 0.5, 0},
                    [](const auto& point, const auto&) { return 1.0 / point.z(); });
  }
}

TEST(ToSensorDepth, WhatIsNoDepthBecomesInvalid) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  for (const DepthKind kind : {DepthKind::Z, DepthKind::Range, DepthKind::Disparity, DepthKind::Inverse}) {
    for (const float value : {0.0f, -0.0f, -1.0f, kNan, kInf, -kInf}) {
      for (const float depth : toSensorDepth(Image<float>(5, 4, value), kPinhole, {kind, 1.0, 1.0}))
        EXPECT_EQ(depth, kInvalidDepth) << value;
    }
  }
  // 1/x of a denormal overflows.
  const Image<float> tiny(5, 4, std::numeric_limits<float>::denorm_min());
  EXPECT_EQ(toSensorDepth(tiny, kPinhole, {DepthKind::Inverse, 1.0, 0})(0, 0), kInvalidDepth);
}

TEST(ToSensorDepth, NothingLiesAheadOfARayThatLooksBack) {
  const Spherical turning{5, 4, -2.5, 1.25, -0.3, 0.2};
  const Image<float> depth = toSensorDepth(Image<float>(5, 4, 1.0f), turning, {DepthKind::Z, 1.0, 0});
  EXPECT_EQ(depth(0, 0), kInvalidDepth);
  EXPECT_GT(depth(2, 0), 0.9f);
  EXPECT_EQ(depth(4, 0), kInvalidDepth);
}

TEST(ToSensorDepth, ImpossibleEncodingsAreRefused) {
  const Image<float> stored(5, 4, 1.0f);
  EXPECT_THROW(toSensorDepth(stored, kPinhole, {DepthKind::Z, 0.0, 0}), InvalidArgument);
  EXPECT_THROW(toSensorDepth(stored, kPinhole, {DepthKind::Z, std::nan(""), 0}), InvalidArgument);
  EXPECT_THROW(toSensorDepth(stored, kPinhole, {DepthKind::Disparity, 1.0, 0.0}), InvalidArgument);
  EXPECT_THROW(toSensorDepth(Image<float>(4, 5, 1.0f), kPinhole, {}), InvalidArgument);
}

TEST(ImportDepth, PackedFloatsAreTakenAsTheyAre) {
  std::vector<float> values(20);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5f + static_cast<float>(i);
  DepthBuffer buffer;
  buffer.data = values.data();
  buffer.width = 5, buffer.height = 4;
  const DepthMap map = importDepth(buffer, kPinhole);
  EXPECT_TRUE(std::equal(values.begin(), values.end(), map.depth.begin()));
  EXPECT_TRUE(map.confidence.empty());
  EXPECT_TRUE(map.color.empty());
}

TEST(ImportDepth, SixteenBitsAreScaledAndSaturatedOnesInvalid) {
  std::vector<std::uint16_t> values(20, 1500);
  values[0] = 0, values[1] = 65535, values[2] = 65534;
  DepthBuffer buffer;
  buffer.data = values.data();
  buffer.type = DepthBuffer::Type::UInt16;
  buffer.width = 5, buffer.height = 4;
  buffer.encoding.scale = 0.001;
  const DepthMap map = importDepth(buffer, kPinhole);
  EXPECT_EQ(map.depth(0, 0), kInvalidDepth);
  EXPECT_EQ(map.depth(1, 0), kInvalidDepth);
  EXPECT_FLOAT_EQ(map.depth(2, 0), 65.534f);
  EXPECT_FLOAT_EQ(map.depth(4, 3), 1.5f);
}

TEST(ImportDepth, RowsMayBePaddedUnalignedAndUpsideDown) {
  constexpr std::ptrdiff_t kStride = 23;
  std::vector<unsigned char> bytes(1 + 4 * kStride, 0xff);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) {
      const float value = wanted(x, y);
      std::memcpy(bytes.data() + 1 + y * kStride + 4 * x, &value, sizeof(value));
    }
  }
  DepthBuffer buffer;
  buffer.data = bytes.data() + 1;
  buffer.width = 5, buffer.height = 4;
  buffer.row_stride = kStride;
  const DepthMap upright = importDepth(buffer, kPinhole);
  buffer.data = bytes.data() + 1 + 3 * kStride;
  buffer.row_stride = -kStride;
  const DepthMap flipped = importDepth(buffer, kPinhole);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 5; ++x) {
      EXPECT_EQ(upright.depth(x, y), wanted(x, y));
      EXPECT_EQ(flipped.depth(x, 3 - y), wanted(x, y));
    }
  }
}

TEST(ImportDepth, BuffersThatDoNotFitAreRefused) {
  const std::vector<float> values(20, 1.0f);
  DepthBuffer buffer;
  buffer.width = 5, buffer.height = 4;
  EXPECT_THROW(importDepth(buffer, kPinhole), InvalidArgument);
  buffer.data = values.data();
  buffer.row_stride = 19;
  EXPECT_THROW(importDepth(buffer, kPinhole), InvalidArgument);
  buffer.row_stride = 0;
  buffer.width = 4, buffer.height = 5;
  EXPECT_THROW(importDepth(buffer, kPinhole), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
