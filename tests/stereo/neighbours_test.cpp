// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/neighbours.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/look_at.h"

namespace vdbfuse {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

const Pinhole kCamera{64, 48, 80, 80, 31.5, 23.5, {}};

PhotographHeader lookingAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  return {"photo", kCamera, lookAt(eye, target, Eigen::Vector3d::UnitZ())};
}

// Around the origin at `distance`.
PhotographHeader onRing(double angle_deg, double distance = 2) {
  const double angle = angle_deg * std::numbers::pi / 180;
  return lookingAt({distance * std::cos(angle), distance * std::sin(angle), 0}, {0, 0, 0});
}

std::vector<PhotographHeader> ring(int count, double step_deg) {
  std::vector<PhotographHeader> photographs;
  for (int i = 0; i < count; ++i) photographs.push_back(onRing(i * step_deg));
  return photographs;
}

// Side by side along x, all looking along y.
std::vector<PhotographHeader> row(int count, double step) {
  std::vector<PhotographHeader> photographs;
  for (int i = 0; i < count; ++i) photographs.push_back(lookingAt({i * step, 0, 0}, {i * step, 1, 0}));
  return photographs;
}

std::vector<std::vector<std::size_t>> partnersAt(const std::vector<PhotographHeader>& photographs,
                                                 const PartnerOptions& options = {}) {
  return choosePartners(photographs, std::vector<DepthInterval>(photographs.size(), {1.8, 2.2}), options);
}

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(DepthsOf, WhatTheHeaderSaysHolds) {
  std::vector<PhotographHeader> photographs = ring(2, 20);
  photographs[0].depth = DepthInterval{0.5, 3};
  EXPECT_EQ(depthsOf(photographs, 0, std::nullopt).near, 0.5);
  EXPECT_EQ(depthsOf(photographs, 0, std::nullopt).far, 3);
}

TEST(DepthsOf, TheBoxCutsWhatTheHeaderSaysAndHoldsWhereTheyExcludeEachOther) {
  std::vector<PhotographHeader> photographs = ring(2, 20);
  const Box box(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1));
  photographs[0].depth = DepthInterval{0.5, 2};
  EXPECT_NEAR(depthsOf(photographs, 0, box).near, 1, 1e-12);
  EXPECT_NEAR(depthsOf(photographs, 0, box).far, 2, 1e-12);
  photographs[0].depth = DepthInterval{5, 6};
  EXPECT_NEAR(depthsOf(photographs, 0, box).near, 1, 1e-12);
  EXPECT_NEAR(depthsOf(photographs, 0, box).far, 3, 1e-12);
}

TEST(DepthsOf, ACameraInsideTheBoxSeesFromATwentiethOfTheFarthest) {
  const DepthInterval depths =
      depthsOf(ring(1, 0), 0, Box(Eigen::Vector3d(-4, -5, -1), Eigen::Vector3d(3, 5, 1)));
  EXPECT_NEAR(depths.far, 6, 1e-12);
  EXPECT_NEAR(depths.near, 0.3, 1e-12);
}

TEST(DepthsOf, ABoxBehindTheCameraIsRefused) {
  const Box behind(Eigen::Vector3d(3, -1, -1), Eigen::Vector3d(4, 1, 1));
  EXPECT_EQ(messageOf([&] { depthsOf(ring(1, 0), 0, behind); }), "box: lies behind photograph photo");
  EXPECT_EQ(messageOf([&] { depthsOf(ring(1, 0), 0, Box()); }), "box: is empty");
}

TEST(DepthsOf, CamerasAroundAnObjectSeeABallAroundIt) {
  for (const auto& photographs : {ring(16, 22.5), ring(2, 20)}) {
    for (std::size_t i = 0; i < photographs.size(); ++i) {
      const DepthInterval depths = depthsOf(photographs, i, std::nullopt);
      EXPECT_NEAR(depths.near, 1, 1e-9);  // half a diagonal: 40 pixels at a focal length of 80
      EXPECT_NEAR(depths.far, 3, 1e-9);
    }
  }
}

TEST(DepthsOf, TheBallIsAsLargeAsAtLeastTwoPhotographsSeeIt) {
  std::vector<PhotographHeader> photographs = ring(4, 30);
  photographs.push_back(onRing(15, 20));  // sees ten times as much, but alone
  EXPECT_NEAR(depthsOf(photographs, 0, std::nullopt).far, 3, 1e-9);
  EXPECT_NEAR(depthsOf(photographs, 4, std::nullopt).near, 19, 1e-9);
}

TEST(DepthsOf, AxesThatDoNotMeetAreMeasuredInDistancesBetweenCameras) {
  std::vector<PhotographHeader> forward;
  for (int i = 0; i < 20; ++i) forward.push_back(lookingAt({0, 0.1 * i, 0}, {0, 10, 0}));
  for (const auto& photographs : {row(20, 0.1), forward}) {
    EXPECT_NEAR(depthsOf(photographs, 0, std::nullopt).near, 0.6, 1e-9);  // 1st of a row: 1, 2, 3, 4, 5 steps
    EXPECT_NEAR(depthsOf(photographs, 10, std::nullopt).far, 40, 1e-9);   // 1, 1, 2, 2, 3 steps
  }
}

TEST(DepthsOf, CamerasThatLookOutwardsDoNotSeeThePointWhereTheirAxesMeet) {
  std::vector<PhotographHeader> photographs;
  for (const PhotographHeader& inward : ring(36, 10)) {
    const Eigen::Vector3d eye = inward.world_from_camera.translation();
    photographs.push_back(lookingAt(eye, 2 * eye));
  }
  const double step = 4 * std::sin(10 * std::numbers::pi / 180);  // two cameras further
  EXPECT_NEAR(depthsOf(photographs, 0, std::nullopt).near, 2 * step, 1e-9);
}

TEST(DepthsOf, PhotographsFromOnePlaceTellNoDepth) {
  const std::string message =
      "photographs: nothing tells the depths of photo: no box, and no photograph from another place";
  EXPECT_EQ(messageOf([] { depthsOf(ring(1, 0), 0, std::nullopt); }), message);
  EXPECT_EQ(messageOf([] { depthsOf(ring(3, 0), 0, std::nullopt); }), message);
}

TEST(ChoosePartners, OfTwoPhotographsEachIsTheOthersWhateverTheAngle) {
  for (const double angle : {0.1, 4.0, 20.0, 70.0, 150.0})
    EXPECT_THAT(partnersAt(ring(2, angle)), ElementsAre(ElementsAre(1), ElementsAre(0))) << angle;
  EXPECT_THAT(partnersAt(ring(1, 0)), ElementsAre(IsEmpty()));
  EXPECT_THAT(partnersAt({}), IsEmpty());
  EXPECT_EQ(messageOf([] { choosePartners(ring(2, 10), {}); }), "depths: must be one per photograph");
}

TEST(ChoosePartners, OnARingOfSixteenTheyAreTwoOnEachSide) {
  const auto partners = partnersAt(ring(16, 22.5));
  for (std::size_t i = 0; i < 16; ++i)  // the fifth would stand at 67.5°
    EXPECT_THAT(partners[i], UnorderedElementsAre((i + 1) % 16, (i + 15) % 16, (i + 2) % 16, (i + 14) % 16));
}

TEST(ChoosePartners, OnADenseRingTheNearestBeyondTheSmallestAngleAreTakenOnBothSides) {
  const auto partners = partnersAt(ring(120, 3), {4, 5, 45});
  for (std::size_t i = 0; i < 120; ++i)
    EXPECT_THAT(partners[i],
                UnorderedElementsAre((i + 2) % 120, (i + 118) % 120, (i + 3) % 120, (i + 117) % 120));
}

TEST(ChoosePartners, AtTheEndOfAnArcTheyAreOnTheOneSideThereIs) {
  EXPECT_THAT(partnersAt(ring(10, 8), {3, 5, 45}).front(), UnorderedElementsAre(1, 2, 3));
}

TEST(ChoosePartners, ADistantOtherSideIsBetterThanTheThirdOnOneSide) {
  std::vector<PhotographHeader> photographs = ring(5, 6);
  photographs.push_back(onRing(-40));
  EXPECT_THAT(partnersAt(photographs, {3, 5, 45}).front(), UnorderedElementsAre(1, 2, 5));
}

TEST(ChoosePartners, OfAVideoTheyAreApartFromTheFrameAndFromEachOther) {
  const auto partners = partnersAt(ring(600, 0.05));  // 30° in all
  for (std::size_t i = 0; i < 600; ++i) {
    ASSERT_EQ(partners[i].size(), 5u);
    const int apart = i >= 200 && i < 400 ? 59 : 30;  // 3°; less where one side is short
    for (const std::size_t a : partners[i]) {
      EXPECT_GE(std::abs(static_cast<int>(a) - static_cast<int>(i)), 100);
      for (const std::size_t b : partners[i])
        EXPECT_TRUE(a == b || std::abs(static_cast<int>(a) - static_cast<int>(b)) >= apart) << i;
    }
  }
}

TEST(ChoosePartners, OfAVideoThatHardlyMovedTheyAreTheFramesFurthestAway) {
  const auto partners = partnersAt(ring(300, 0.005));  // 1.5° in all
  ASSERT_EQ(partners[150].size(), 5u);
  EXPECT_THAT(partners[150], testing::IsSupersetOf({std::size_t{0}, std::size_t{299}}));
  EXPECT_THAT(partners[0], testing::Contains(std::size_t{299}));
  for (const std::size_t partner : partners[0]) EXPECT_GE(partner, 150u);
}

TEST(ChoosePartners, CamerasThatLookAwayAreNoPartners) {
  std::vector<PhotographHeader> photographs = ring(3, 20);
  const Eigen::Vector3d eye = onRing(10).world_from_camera.translation();
  photographs.push_back(lookingAt(eye, 2 * eye));
  const auto partners = partnersAt(photographs);
  EXPECT_THAT(partners[0], UnorderedElementsAre(1, 2));
  EXPECT_THAT(partners[3], IsEmpty());
}

TEST(ChoosePartners, WhoSeesOnlyTheRimOfThePictureIsTakenLastButTaken) {
  std::vector<PhotographHeader> photographs = ring(3, 20);
  const Eigen::Vector3d eye = onRing(10).world_from_camera.translation();
  photographs.push_back(lookingAt(eye, {0, 1.3, 0}));
  EXPECT_THAT(partnersAt(photographs)[0], ElementsAre(1, 2, 3));
  EXPECT_THAT(partnersAt({photographs[0], photographs[3]})[0], ElementsAre(1));
}

TEST(ChoosePartners, AMuchCoarserPhotographIsTakenOnlyForWantOfOthers) {
  std::vector<PhotographHeader> photographs{onRing(0), onRing(10, 8), onRing(30), onRing(-40)};
  EXPECT_THAT(partnersAt(photographs, {2, 5, 45})[0], UnorderedElementsAre(2, 3));
  EXPECT_THAT(partnersAt(photographs, {3, 5, 45})[0], UnorderedElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace vdbfuse
