// SPDX-License-Identifier: Apache-2.0
#include "formats/tum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "formats/camera_samples.h"
#include "formats/tiny_scene.h"
#include "formats/trajectory.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

struct TinyTum : TemporaryFolder {
  TinyTum() {
    std::vector<View> views = test::tinyViews();
    for (std::size_t i = 0; i < views.size(); ++i) views[i].name = "130503150" + std::to_string(i) + ".5";
    writeDepthSet(path() / "set", "tum", ViewSequence::fromViews(views));
  }
  std::filesystem::path file(const std::string& name) const { return path() / "set" / name; }
  DepthSet read(const ReadOptions& options = {}) const { return readDepthSet(path() / "set", options); }
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    return message.substr(std::min(message.size(), (path() / "set").string().size()));
  }
};

TEST(Tum, DepthIsInFiveThousandthsOfAMetre) {
  const TinyTum folder;
  const DepthSet set = folder.read();
  test::expectSameViews(set.views, test::tinyViews(), 0.000101);
  EXPECT_DOUBLE_EQ(set.reading.scale, 0.0002);
  EXPECT_EQ(set.reading.kind, DepthKind::Z);
  EXPECT_EQ(set.reading.stored, "16-bit PNG");
  EXPECT_EQ(set.views.header(1).name, "1305031501.5");
}

TEST(Tum, PosesAreTakenBetweenTheirNeighbours) {
  const TinyTum folder;
  writeText(folder.file("groundtruth.txt"),
            "# comment\n1305031500.49 1 0 0 0 0 0 1\n1305031500.51 3 0 0 0 0 0.0998334 0.9950042\n");
  const DepthSet set = folder.read();
  ASSERT_EQ(set.views.size(), 1u);
  const RigidTransform& pose = set.views.header(0).world_from_camera;
  EXPECT_NEAR(pose.translation().x(), 2, 1e-5);
  EXPECT_NEAR(Eigen::AngleAxisd(pose.linear()).angle(), 0.1, 1e-5);
  EXPECT_THAT(set.notes, testing::Contains("2 depth maps without a pose within 0.02 s left out"));
}

TEST(Tum, CameraThatTheAuthorsRecommendIsTakenWhereThereIsNone) {
  const TinyTum folder;
  std::filesystem::remove(folder.file("intrinsics.txt"));
  const DepthSet set = folder.read();
  // Made for 640x480, here 24x18.
  EXPECT_NEAR(std::get<Pinhole>(set.views.header(0).projection).fx, 525.0 * 24 / 640, 1e-9);
  EXPECT_THAT(set.notes, testing::Contains(testing::HasSubstr("525, 525, 319.5, 239.5 (--intrinsics)")));
}

TEST(Tum, LeftHandedCameraOfIclNuimIsTurnedIntoARightHandedOne) {
  const TemporaryFolder folder;
  test::writeIclNuim(folder.path());
  const DepthSet set = readDepthSet(folder.path());
  test::expectSameViews(set.views, test::tinyViews(), 0.000101);
  EXPECT_THAT(set.notes, testing::Contains(testing::HasSubstr("left-handed camera")));
  EXPECT_EQ(set.views.load(0).map.color, test::tinyViews()[0].map.color);
}

TEST(Tum, AssociationsMayNameTheColourFirst) {
  const TemporaryFolder folder;
  test::writeIclNuim(folder.path());
  writeText(folder / "associations.txt", "0 rgb/0.png 0 depth/0.png\n1 rgb/1.png 1 depth/1.png\n");
  EXPECT_EQ(readDepthSet(folder.path()).views.size(), 2u);
}

TEST(Tum, BrokenListsAreRefusedWithTheirLine) {
  const TinyTum folder;
  const std::string poses = readText(folder.file("groundtruth.txt")),
                    depths = readText(folder.file("depth.txt"));
  writeText(folder.file("groundtruth.txt"), "# c\n0 1 2 3\n");
  EXPECT_EQ(folder.complaint(),
            "/groundtruth.txt: line 2: expected time tx ty tz qx qy qz qw, found 4 words");
  writeText(folder.file("groundtruth.txt"), "0 1 2 3 0 0 0 2\n");
  EXPECT_EQ(folder.complaint(),
            "/groundtruth.txt: line 1: expected a quaternion of length 1, found length 2");
  writeText(folder.file("groundtruth.txt"), "0 1 nan 3 0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/groundtruth.txt: line 1: expected a finite number, found 'nan'");
  writeText(folder.file("groundtruth.txt"), "# nothing\n");
  EXPECT_EQ(folder.complaint(), "/groundtruth.txt: expected a line 'time tx ty tz qx qy qz qw', found none");
  writeText(folder.file("groundtruth.txt"), "7 1 2 3 0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/groundtruth.txt: expected a pose within 0.02 s of a depth map, found none");
  writeText(folder.file("groundtruth.txt"), poses);
  writeText(folder.file("depth.txt"), "1305031500.5 ../../secret.png\n");
  EXPECT_EQ(folder.complaint(),
            "/depth.txt: line 1: expected a path inside the data set, found '../../secret.png'");
  writeText(folder.file("depth.txt"), "1305031500.5 depth/7.png\n");
  EXPECT_EQ(folder.complaint(), "/depth/7.png: expected the depth map of view 7, found nothing of that name");
  writeText(folder.file("depth.txt"), "1305031500.5\n");
  EXPECT_EQ(folder.complaint(), "/depth.txt: line 1: expected time and file name, found 1 words");
  std::filesystem::remove(folder.file("groundtruth.txt"));
  EXPECT_EQ(folder.complaint(), ": expected a trajectory (groundtruth.txt or one *.freiburg), found none");
}

TEST(Trajectory, NearestPoseCountsWhereNeighboursAreFarApart) {
  std::vector<StampedPose> trajectory(2);
  trajectory[0].time = 1, trajectory[1].time = 2;
  trajectory[1].pose.translation().x() = 5;
  EXPECT_EQ(poseAt(trajectory, 1.99, 0.02)->translation().x(), 5);
  EXPECT_EQ(poseAt(trajectory, 0.99, 0.02)->translation().x(), 0);
  EXPECT_FALSE(poseAt(trajectory, 1.5, 0.02));
  EXPECT_FALSE(poseAt(trajectory, 2.03, 0.02));
}

}  // namespace
}  // namespace vdbfuse
