// SPDX-License-Identifier: Apache-2.0
#include "formats/transforms.h"

#include <gtest/gtest.h>

#include <string>

#include "formats/tiny_scene.h"
#include "formats/transforms_sample.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

const std::string kLens = R"("fl_x": 4, "fl_y": 5, "cx": 2, "cy": 1.5, "w": 4, "h": 3)";
const std::string kFrame =
    R"({"depth_file_path": "a.png", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})";

// One frame of 4x3 pixels at 1500; the camera looks along -z.
struct TinyFolder : TemporaryFolder {
  explicit TinyFolder(const std::string& all = kLens, const std::string& frames = kFrame) {
    writePng(*this / "a.png", Image<std::uint16_t>(4, 3, std::uint16_t{1500}));
    writeText(*this / "transforms.json", "{" + all + ",\n\"frames\": [" + frames + "]}");
  }
  DepthSet read(const ReadOptions& options = {}) const { return readTransforms(path(), options); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string complaintAbout(const std::string& all, const std::string& frames = kFrame) {
  return TinyFolder(all, frames).complaint();
}

Pinhole cameraOf(const DepthSet& set) { return std::get<Pinhole>(set.views.header(0).projection); }

TEST(Transforms, BothProgramsSetsGiveTheSameViews) {
  for (const auto write : {test::writeInstantNgpSample, test::writeNerfstudioSample}) {
    const TemporaryFolder folder;
    write(folder.path());
    test::expectSameViews(readTransforms(folder.path(), {}).views, test::tinyViews(), 0.00051);
  }
}

TEST(Transforms, CameraLooksAlongItsNegativeZ) {
  const TinyFolder folder;
  const DepthSet set = readTransforms(folder / "transforms.json", {});
  const View view = set.views.load(0);
  EXPECT_EQ(view.name, "a");
  EXPECT_EQ(cameraOf(set), (Pinhole{4, 3, 4, 5, 1.5, 1, {}}));
  EXPECT_TRUE((view.world_from_camera * Eigen::Vector3d(1, 2, 3)).isApprox(Eigen::Vector3d(1, -2, -3)));
  EXPECT_FLOAT_EQ(view.map.depth(1, 1), 1.5F);
}

TEST(Transforms, StatedUnitsScaleDepths) {
  EXPECT_FLOAT_EQ(TinyFolder(kLens + R"(,"integer_depth_scale": 0.01)").read().views.load(0).map.depth(0, 0),
                  15);
  const TinyFolder folder(kLens + R"(,"depth_unit_scale_factor": 0.002)");
  EXPECT_FLOAT_EQ(folder.read().views.load(0).map.depth(0, 0), 3);
  writePfm(folder / "a.png", Image<float>(4, 3, 2.0F));  // floats by content, not by name
  EXPECT_FLOAT_EQ(folder.read().views.load(0).map.depth(0, 0), 0.004F);
  writeText(folder / "transforms.json", "{" + kLens + ",\"frames\": [" + kFrame + "]}");
  EXPECT_FLOAT_EQ(folder.read().views.load(0).map.depth(0, 0), 2);
}

TEST(Transforms, LensIsThatOfTheFrameBeforeThatOfTheFile) {
  std::string frame = kFrame;
  frame.insert(1, R"("fl_x": 7, "k1": 0.25, "p2": -0.5, )");
  const Pinhole camera = cameraOf(TinyFolder(kLens, frame).read());
  EXPECT_EQ(camera.fx, 7);
  EXPECT_EQ(camera.distortion, (std::array<double, 5>{0.25, 0, 0, -0.5, 0}));
}

TEST(Transforms, MissingFieldsHaveTheirUsualMeaning) {
  EXPECT_EQ(cameraOf(TinyFolder(R"("fl_x": 8, "w": 8, "h": 6)").read()), (Pinhole{4, 3, 4, 4, 1.5, 1, {}}));
  const Pinhole camera = cameraOf(TinyFolder(R"("camera_angle_x": 1.5707963267948966)").read());
  EXPECT_NEAR(camera.fx, 2, 1e-12);
  EXPECT_EQ(camera.fy, camera.fx);
  ReadOptions options;
  options.intrinsics = {{9, 8, 1, 2}};
  EXPECT_EQ(cameraOf(TinyFolder("\"x\": 1").read(options)), (Pinhole{4, 3, 9, 8, 1, 2, {}}));
}

TEST(Transforms, WhatIsLeftOutIsNoted) {
  const std::string other =
      R"(, {"file_path": "b.png", "transform_matrix": []}, {"file_path": "c.png", "mask_path": "m.png", )" +
      kFrame.substr(1);
  EXPECT_EQ(
      TinyFolder(kLens + ",\"applied_scale\": 2", kFrame + other).read().notes,
      (std::vector<std::string>{
          "1 frame without a depth map left out", "1 picture missing or of another kind than PNG and JPEG",
          "1 mask of mask_path left out; --masks FOLDER reads them",
          "applied_transform and applied_scale, which the poses contain, are not undone"}));
}

TEST(Transforms, OtherCamerasAreRefusedByName) {
  const std::string expected =
      ": expected a perspective camera (OPENCV, PINHOLE, SIMPLE_PINHOLE, SIMPLE_RADIAL, RADIAL), found ";
  EXPECT_EQ(complaintAbout(kLens + R"(,"camera_model": "OPENCV_FISHEYE")"),
            "/transforms.json: camera_model" + expected + "'OPENCV_FISHEYE'");
  EXPECT_EQ(complaintAbout(kLens + R"(,"is_fisheye": true)"),
            "/transforms.json: is_fisheye" + expected + "true");
  EXPECT_EQ(complaintAbout(kLens + R"(,"k4": 0.5)"),
            "/transforms.json: k4: expected a camera of OpenCV's model, which has no k4, found 0.5");
}

TEST(Transforms, BrokenFilesAreRefusedWithTheirPlace) {
  const auto withPose = [](const std::string& pose) {
    return complaintAbout(kLens, R"({"depth_path": "a.png", "transform_matrix": )" + pose + "}");
  };
  EXPECT_EQ(complaintAbout("\"w\": [1,}"), "/transforms.json: line 1: expected JSON, found something else");
  EXPECT_EQ(complaintAbout("\"w\": 1e999"),
            "/transforms.json: expected JSON, found a number that is too large");
  EXPECT_EQ(complaintAbout(kLens, kFrame + "]"),
            "/transforms.json: line 2: expected JSON, found something else");
  EXPECT_EQ(complaintAbout("\"fl_y\": 3"),
            "/transforms.json: frames[0]: expected a field 'fl_x' or 'camera_angle_x', found none");
  EXPECT_EQ(complaintAbout(R"("fl_x": "4")"), "/transforms.json: fl_x: expected a number, found a string");
  EXPECT_EQ(complaintAbout(R"("fl_x": 4, "w": 2.5, "h": 3)"),
            "/transforms.json: w: expected a whole number from 1 to 1048576, found 2.5");
  EXPECT_EQ(complaintAbout(kLens, R"({"depth_path": "a.png"})"),
            "/transforms.json: frames[0]: expected a field 'transform_matrix', found none");
  EXPECT_EQ(withPose("[[1,0,0,0],[0,1,0,0]]"),
            "/transforms.json: frames[0].transform_matrix: expected a matrix of 3 or 4 rows, found 2");
  EXPECT_EQ(withPose("[[1,0,0,0],[0,1,0,0],[0,0,1]]"),
            "/transforms.json: frames[0].transform_matrix[2]: expected 4 numbers, found 3");
  EXPECT_EQ(
      withPose("[[2,0,0,0],[0,1,0,0],[0,0,1,0]]"),
      "/transforms.json: frames[0].transform_matrix: expected a rotation, found a matrix R with |RᵀR - 1| "
      "= 3");
  EXPECT_EQ(complaintAbout(kLens, "{}"),
            "/transforms.json: frames: expected a frame with depth_file_path or depth_path, found none");
  EXPECT_EQ(complaintAbout(kLens, R"({"depth_path": "b.png"})"),
            "/b.png: expected the depth map of frames[0], found nothing of that name");
  EXPECT_EQ(complaintAbout(kLens + ",\"integer_depth_scale\": 0"),
            "/transforms.json: integer_depth_scale: expected a number above 0, found 0");
}

TEST(Transforms, PathsThatLeadOutOfTheFolderAreRefused) {
  EXPECT_EQ(complaintAbout(kLens, R"({"depth_path": "../a.png"})"),
            "/transforms.json: frames[0].depth_path: expected a path inside the data set, found '../a.png'");
  EXPECT_EQ(
      complaintAbout(kLens, R"({"file_path": "/etc/passwd", )" + kFrame.substr(1)),
      "/transforms.json: frames[0].file_path: expected a path inside the data set, found '/etc/passwd'");
}

TEST(Transforms, StepOfWrittenDepthsFitsTheLargest) {
  const TemporaryFolder folder;
  std::vector<View> truth = test::tinyViews(2);
  for (View& view : truth) {
    for (float& depth : view.map.depth) depth *= 0.1F;
  }
  writeDepthSet(folder / "set", "transforms", ViewSequence::fromViews(truth));
  const DepthSet set = readDepthSet(folder / "set");
  EXPECT_LT(set.reading.scale, 1e-5);
  test::expectSameViews(set.views, truth, 0.5 * set.reading.scale + 1e-6);
}

TEST(Transforms, DistortedCamerasAndLargerPicturesComeBack) {
  const TemporaryFolder folder;
  std::vector<View> truth = test::tinyViews(2);
  std::get<Pinhole>(truth[1].projection).distortion = {0.1, -0.2, 0.001, 0.002, 0.05};
  truth[0].map.color = Image<Rgb8>(48, 36, Rgb8{4, 5, 6});
  writeDepthSet(folder / "set", "transforms", ViewSequence::fromViews(truth));
  const DepthSet set = readDepthSet(folder / "set");
  test::expectSameViews(set.views, truth, 0.00051);
  EXPECT_EQ(std::get<Pinhole>(set.views.header(1).projection).distortion,
            std::get<Pinhole>(truth[1].projection).distortion);
}

}  // namespace
}  // namespace vdbfuse
