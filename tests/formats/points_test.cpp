// SPDX-License-Identifier: Apache-2.0
#include "formats/points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "formats/points_sample.h"
#include "formats/sensor_groups.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

struct Folder : TemporaryFolder {
  explicit Folder(void (*write)(const std::filesystem::path&)) { write(path()); }
  // The message without the folder's own name.
  std::string complaint(const std::string& input = "") const {
    const auto path_of_input = input.empty() ? path() : *this / input;
    const std::string message = messageOf<IoError>([&] { readPointScans(path_of_input, {}); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
  std::string complaintAbout(const std::string& file, const std::string& text) const {
    writeText(*this / file, text);
    return complaint(file);
  }
};

TEST(Points, SensorsStandWhereTheirPosesSay) {
  for (const auto write :
       {test::writeXyzWithPoses, test::writePcdWithTrajectory, test::writePlyWithNumberedPoses}) {
    const Folder folder(write);
    const DepthSet set = readPointScans(folder.path(), {});
    const std::vector<RigidTransform> truth = test::tinyScanners();
    ASSERT_EQ(set.views.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const RigidTransform world_from_stored =
          set.views.header(i).world_from_camera * set.stored_from_camera[i].inverse();
      EXPECT_TRUE(world_from_stored.isApprox(truth[i], 1e-6)) << i;
    }
    test::expectOnSurface(set.views, 0.02, 0.1);
  }
}

TEST(Points, FilesWithSensorsAreTakenApartByTheirPositions) {
  using Written = std::pair<void (*)(const std::filesystem::path&), const char*>;
  for (const auto& [write, file] :
       {Written{test::writePlyWithSensors, "points.ply"}, Written{test::writeXyzWithSensors, "points.xyz"},
        Written{test::writePcdWithSensors, "points.pcd"}}) {
    const Folder folder(write);
    const DepthSet set = readPointScans(folder / file, {});
    ASSERT_EQ(set.views.size(), 2u) << file;
    EXPECT_EQ(set.notes.size(), 1u) << file;
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_TRUE(set.views.header(i).world_from_camera.translation().isApprox(
          test::tinyScanners()[i].translation(), 1e-5));
    test::expectOnSurface(set.views, 0.02, 0.1);
  }
}

TEST(Points, SensorsAreTurnedTowardsPointsBelowThemAndLevelElse) {
  const Folder folder(test::writeXyzWithSensors);
  const DepthSet set = readPointScans(folder / "points.xyz", {});
  EXPECT_LT(set.views.header(0).world_from_camera.linear()(2, 2), -0.9);
  EXPECT_NEAR(set.views.header(1).world_from_camera.linear()(2, 2), 0, 1e-6);
}

TEST(Points, OptionsOfPointsAreObeyed) {
  const Folder folder(test::writeXyzWithSensors);
  const std::filesystem::path file = folder / "points.xyz";
  ReadOptions options;
  options.max_depth = 1.5;
  const Image<float> depth = readPointScans(file, options).views.load(0).map.depth;
  EXPECT_LE(*std::max_element(depth.begin(), depth.end()), 1.5F);
  options = {};
  options.depth_scale = 2;
  EXPECT_NEAR(readPointScans(file, options).views.header(0).world_from_camera.translation().z(), 3.5, 1e-6);
  options = {};
  options.splat_step = 0.05;
  const Projection projection = readPointScans(file, options).views.header(0).projection;
  EXPECT_EQ(std::get<Spherical>(projection).elevation_step, 0.05);
  options = {};
  options.intrinsics = {{5, 6, 1, 2}};
  EXPECT_THROW(readPointScans(file, options), InvalidArgument);
}

TEST(Points, WithoutASensorAreRefused) {
  const Folder folder(test::writePlyWithNumberedPoses);
  EXPECT_EQ(folder.complaint("scan000.ply"),
            "/scan000.ply: expected the position of the sensor for each point (sensor_x, vp_x, origin_x, "
            "...), or a "
            "folder with poses of the scans, found none");
  EXPECT_EQ(folder.complaintAbout("a.xyz", "1 2 3\n"),
            "/a.xyz: expected six columns x y z and the position of the sensor, or a folder with poses of "
            "the scans, "
            "found 3 columns");
  EXPECT_EQ(
      folder.complaintAbout("a.txt", "1 2 3 0 0 1\n1 2 4 0 1 0\n"),
      "/a.txt: columns 4 to 6: expected the position of the sensor for each point, found vectors of length 1 "
      "(normals?)");
  EXPECT_EQ(folder.complaintAbout("a.xyz", "1 2 3 0 9 1\n1 2 4 255 1 0\n"),
            "/a.xyz: columns 4 to 6: expected the position of the sensor for each point, found whole numbers "
            "from 0 "
            "to 255 (colours?)");
}

TEST(Points, BrokenTextIsRefusedWithItsLine) {
  const Folder folder(test::writeXyzWithPoses);
  writeText(folder / "a.xyz", "x y z\n\n1,2,3\n4 5\n");
  EXPECT_EQ(folder.complaint(), "/a.xyz: line 4: expected a number, found the end of the line");
  writeText(folder / "a.xyz", "2\n1 2 3\n4 5 six\n");
  EXPECT_EQ(folder.complaint(), "/a.xyz: line 3: expected a number, found 'six'");
  writeText(folder / "a.xyz", "# nothing\n");
  EXPECT_EQ(folder.complaint(),
            ": scan a: expected points that make a depth map, found scan: expected points, found none that "
            "is finite");
}

TEST(Points, MissingAndBrokenPosesAreRefused) {
  const Folder folder(test::writeXyzWithPoses);
  writeText(folder / "b.pose.txt", "1 0 0 0\n0 1 0 0\n");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 3: expected a 4x4 or 3x4 pose matrix, found the end of the file");
  std::filesystem::remove(folder / "b.pose.txt");
  EXPECT_EQ(folder.complaint(), ": expected the pose of b.xyz (b.pose.txt), found nothing of that name");
  writeText(folder / "trajectory.txt", "a 0 0 0 0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/trajectory.txt: expected the pose of b.xyz, found none of that name");
  writeText(folder / "trajectory.txt", "1.5 0 0 0 0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/trajectory.txt: expected a line for each of 2 scans, found 1 line");
  writeText(folder / "trajectory.txt", "1.5 0 0 0 0 0 0\n");
  EXPECT_EQ(folder.complaint(), "/trajectory.txt: line 1: expected name tx ty tz qx qy qz qw, found 7 words");
  writeText(folder / "trajectory.txt", "a 0 0 nan 0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/trajectory.txt: line 1: expected a finite number, found 'nan'");
}

TEST(Points, NamesInATrajectoryComeBeforeItsOrder) {
  const Folder folder(test::writeXyzWithPoses);
  writeText(folder / "trajectory.txt", "b.xyz 5 0 0 0 0 0 1\na 7 0 0 0 0 0 1\n");
  const DepthSet set = readPointScans(folder.path(), {});
  EXPECT_EQ(set.views.header(0).world_from_camera.translation().x(), 7);
  EXPECT_EQ(set.views.header(1).world_from_camera.translation().x(), 5);
}

TEST(Points, BrokenCloudsAreRefused) {
  const Folder folder(test::writePcdWithSensors);
  const std::string good = readText(folder / "points.pcd");
  const auto complaint = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return folder.complaintAbout("points.pcd", text);
  };
  EXPECT_EQ(complaint("DATA ascii", "DATA binary_compressed"),
            "/points.pcd: expected DATA ascii or binary (unorganised clouds), found binary_compressed");
  EXPECT_EQ(complaint("POINTS 8450", "POINTS 8451"),
            "/points.pcd: line 10: expected POINTS 8450 (WIDTH x HEIGHT), found 8451");
  EXPECT_EQ(
      complaint("COUNT 1 1 1 1", "COUNT 1 1 1 2"),
      "/points.pcd: field vp_x: expected one number of 1, 2, 4 or 8 bytes, found SIZE 4, TYPE F, COUNT 2");
  EXPECT_EQ(
      complaint("SIZE 4 4 4 4", "SIZE 4 4 4 2"),
      "/points.pcd: field vp_x: expected one number of 1, 2, 4 or 8 bytes, found SIZE 2, TYPE F, COUNT 1");
  std::string large = good;
  for (const char* key : {"WIDTH ", "POINTS "})
    large.insert(large.find(key) + std::string(key).size(), "10000");
  EXPECT_THAT(folder.complaintAbout("points.pcd", large),
              testing::StartsWith("/points.pcd: expected 100008450 points, found room for "));
}

TEST(SensorGroups, PositionsNearEachOtherAreOne) {
  SensedPoints sensed;
  for (int i = 0; i < 1000; ++i) {
    sensed.sensors.emplace_back(0.001 * i, 0, 0);
    sensed.points.emplace_back(0.001 * i, 10, 0);
  }
  sensed.points.emplace_back(std::nan(""), 0, 0);
  sensed.sensors.emplace_back(99, 0, 0);
  const SensorGroups groups = groupBySensor(sensed);
  EXPECT_TRUE(groups.is_moving);
  EXPECT_NEAR(groups.reach, 0.1, 1e-12);
  ASSERT_EQ(groups.groups.size(), 10u);
  std::size_t points = 0;
  for (const SensorGroup& group : groups.groups) points += group.points.size();
  EXPECT_EQ(points, 1000u);
  EXPECT_NEAR(groups.groups[0].sensor.x(), 0.05, 0.001);
  EXPECT_NEAR(groups.groups[0].points[0].x(), -0.05, 0.001);
}

TEST(SensorGroups, SensorsThatStandStillAreKeptApartWhateverTheOrder) {
  SensedPoints sensed;
  for (int i = 0; i < 100; ++i) {
    sensed.sensors.emplace_back(i % 2, 0, 0);
    sensed.points.emplace_back(i, 5, 1);
  }
  const SensorGroups groups = groupBySensor(sensed);
  EXPECT_FALSE(groups.is_moving);
  ASSERT_EQ(groups.groups.size(), 2u);
  EXPECT_EQ(groups.groups[0].points.size(), 50u);
}

TEST(SensorGroups, TooManyPositionsAreRefused) {
  SensedPoints sensed;
  for (int i = 0; i < 10001; ++i) {
    sensed.sensors.emplace_back(i, 0, 0);
    sensed.points.emplace_back(i, 1, 0);
  }
  EXPECT_EQ(
      messageOf<InvalidArgument>([&] { groupBySensor(sensed); }),
      "points: expected at most 10000 positions of the sensor, 1 % of the median range apart, found more");
  sensed.points = sensed.sensors;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { groupBySensor(sensed); }),
            "points: expected finite points away from their sensor, found none");
}

TEST(Points, MovingSensorsAreNoted) {
  const Folder folder(test::writeXyzWithPoses);
  std::string text;
  for (int i = 0; i < 400; ++i)
    text +=
        std::to_string(i % 20) + " " + std::to_string(i / 20) + " 0 " + std::to_string(0.001 * i) + " 5 10\n";
  writeText(folder / "m.xyz", text);
  const DepthSet set = readPointScans(folder / "m.xyz", {});
  EXPECT_THAT(set.notes.back(), testing::StartsWith("the sensor moves: positions within 0.1"));
}

}  // namespace
}  // namespace vdbfuse
