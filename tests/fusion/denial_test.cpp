// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fusion/scenes.h"

namespace vdbfuse {
namespace {

constexpr int kSide = 64;
constexpr std::uint8_t kNobody = PixelTestimony::kDenials - 1;
// Ends of bins in evidence: below −1 is denied; around 0 nothing is known. In front of a surface the views
// from behind, whose shadow it is, weigh a little against those that see past it.
constexpr std::uint8_t kDenied = 2, kUnknown = 4;

Testimonies examined(const JudgedViews& judged) {
  Testimonies testimonies;
  for (const JudgedView& view : judged.views)
    testimonies.views.emplace_back(view.depth.width(), view.depth.height());
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.7);
  examineDenial(judged, Box(-half, half), testimonies, {});
  return testimonies;
}

JudgedViews sphere(int count) { return believe(test::sphereViews(count, kSide), test::sphereSensor(), 0.01); }

bool inPatch(int x, int y) { return std::abs(x - kSide / 2) < 4 && std::abs(y - kSide / 2) < 4; }

// Pixels in the middle of view 0 that claim to have seen through most of the sphere.
JudgedViews drilled() {
  JudgedViews judged = sphere(48);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (inPatch(x, y)) judged.views[0].depth(x, y) += 0.5f;
    }
  }
  return judged;
}

// Rays at the rim come in flat and pass grid points inside the sphere.
bool farFromRim(int x, int y) { return std::hypot(x - kSide / 2, y - kSide / 2) < 20; }

TEST(Denial, NobodyDeniesWhatIsThere) {
  for (const Image<PixelTestimony>& view : examined(sphere(48)).views) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        if (farFromRim(x, y)) {
          EXPECT_GT(view(x, y).denial, kUnknown) << x << ' ' << y;
        }
      }
    }
  }
}

// Of a pinhole that is distorted by nothing it is not known where its rays go, so that all are followed all
// the way.
TEST(Denial, WhatIsPassedOverWouldHaveSaidNothing) {
  JudgedViews judged = drilled();
  const Testimonies plain = examined(judged);
  for (JudgedView& view : judged.views) std::get<Pinhole>(view.projection).distortion[0] = 1e-13;
  const Testimonies bent = examined(judged);
  int examined_pixels = 0, denied = 0, different = 0;
  for (std::size_t i = 0; i < plain.views.size(); ++i) {
    for (std::size_t p = 0; p < plain.views[i].size(); ++p) {
      const auto one = plain.views[i].data()[p].denial, other = bent.views[i].data()[p].denial;
      examined_pixels += judged.views[i].depth.data()[p] != kInvalidDepth;
      denied += other < kNobody, different += one != other;
    }
  }
  EXPECT_GT(denied, 1000);
  EXPECT_LT(different, examined_pixels / 1000);  // points on the border of two pixels
}

// With the incidence known, flat rays are examined less far.
TEST(Denial, NorWhereRaysAreKnownToComeInFlat) {
  JudgedViews judged = sphere(48);
  for (JudgedView& view : judged.views) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const float depth = view.depth(x, y);
        if (depth == kInvalidDepth) continue;
        const Eigen::Vector3d ray = view.world_from_camera.linear() *
                                    rayDirection(view.projection, x, y, depth),
                              point = view.world_from_camera * unproject(view.projection, x, y, depth);
        view.incidence(x, y) = static_cast<float>(std::abs(ray.dot(point.normalized())));
      }
    }
  }
  const auto deniedPixels = [](const Testimonies& said) {
    std::ptrdiff_t count = 0;
    for (const Image<PixelTestimony>& view : said.views)
      count += std::count_if(view.begin(), view.end(), [](const auto& p) { return p.denial <= kDenied; });
    return count;
  };
  EXPECT_LT(deniedPixels(examined(judged)), deniedPixels(examined(sphere(48))) / 2);
}

TEST(Denial, PixelsThatDrillIntoTheObjectAreDeniedByTheOthersAndOnlyThose) {
  const JudgedViews judged = drilled();
  const Testimonies said = examined(judged);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (judged.views[0].depth(x, y) == kInvalidDepth) continue;
      if (inPatch(x, y)) {
        EXPECT_LE(said.views[0](x, y).denial, kDenied) << x << ' ' << y;
      }
      // Rays at the patch's rim pass grid points that its pixels claim.
      if (farFromRim(x, y) && std::abs(x - kSide / 2) > 8) {
        EXPECT_GE(said.views[0](x, y).denial, kUnknown) << x << ' ' << y;
      }
    }
  }
}

TEST(Denial, OfAViewAloneNothingIsKnown) {
  const JudgedViews judged = sphere(1);
  const Testimonies said = examined(judged);
  for (std::size_t p = 0; p < said.views[0].size(); ++p)
    EXPECT_EQ(said.views[0].data()[p].denial, judged.views[0].depth.data()[p] > 0 ? kUnknown : kNobody);
}

// A domain that the rays hardly touch, and whose sides are no multiples of a brick.
TEST(Denial, RaysThatMissTheDomainAreDeniedByNobody) {
  const JudgedViews judged = drilled();
  Testimonies testimonies;
  for (const JudgedView& view : judged.views)
    testimonies.views.emplace_back(view.depth.width(), view.depth.height());
  examineDenial(judged, Box(Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(5.5, 5.2, 5.01)), testimonies, {});
  for (const Image<PixelTestimony>& view : testimonies.views)
    for (const PixelTestimony& pixel : view) EXPECT_EQ(pixel.denial, kNobody);
}

}  // namespace
}  // namespace vdbfuse
