// SPDX-License-Identifier: Apache-2.0
#include "formats/open3d.h"

#include <gtest/gtest.h>

#include <string>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

const std::string kIntrinsic =
    R"({"width": 8, "height": 6, "intrinsic_matrix": [8, 0, 0, 0, 10, 0, 3.5, 2.5, 1]})";

std::string block(int index, double x) {
  return std::to_string(index) + " " + std::to_string(index) + " 9\n1 0 0 " + std::to_string(x) +
         "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
}

std::string parameter(double x) {
  return R"({"extrinsic": [1,0,0,0, 0,1,0,0, 0,0,1,0, )" + std::to_string(x) + R"(,0,0,1], "intrinsic": )" +
         kIntrinsic + "}";
}

// Three depth maps of 4x3 pixels, with pictures of other names.
struct TinyFolder : TemporaryFolder {
  TinyFolder() {
    for (const char* name : {"depth", "image"}) std::filesystem::create_directory(*this / name);
    for (const int i : {2, 10, 9}) {
      writePng(*this / ("depth/f" + std::to_string(i) + ".png"),
               Image<std::uint16_t>(4, 3, static_cast<std::uint16_t>(1000 + i)));
      writePng(*this / ("image/000" + std::to_string(i) + ".png"),
               Image<Rgb8>(4, 3, Rgb8{static_cast<std::uint8_t>(i), 0, 0}));
    }
    writeText(log(), block(0, 1) + block(1, 2) + block(2, 3));
    writeText(*this / "camera_primesense.json", kIntrinsic);
  }
  std::filesystem::path log() const { return *this / "scene.log"; }
  DepthSet read(const ReadOptions& options = {}) const { return readOpen3d(path(), options); }
  double x(std::size_t view) const { return read().views.header(view).world_from_camera.translation().x(); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
  std::string complaintAbout(const std::string& text) const {
    writeText(log(), text);
    return complaint();
  }
};

TEST(Open3d, DepthMapsAreOrderedByNumber) {
  const TinyFolder folder;
  const DepthSet set = folder.read();
  ASSERT_EQ(set.views.size(), 3u);
  EXPECT_EQ(set.views.header(0).name, "f2");
  EXPECT_EQ(set.views.header(2).name, "f10");
  const View view = set.views.load(2);
  EXPECT_FLOAT_EQ(view.map.depth(0, 0), 1.01F);
  EXPECT_EQ(view.map.color(0, 0)[0], 10);
  EXPECT_EQ(view.world_from_camera.translation().x(), 3);
  EXPECT_EQ(std::get<Pinhole>(view.projection), (Pinhole{4, 3, 4, 5, 1.5, 1, {}}));
}

TEST(Open3d, NumbersOfTheLogNameDepthMapsWhereTheyAreNotAsMany) {
  const TinyFolder folder;
  writeText(folder.log(), block(2, 7) + block(0, 5));
  EXPECT_EQ(folder.x(0), 5);
  EXPECT_EQ(folder.x(1), 7);
  EXPECT_EQ(folder.read().views.header(1).name, "f10");
  EXPECT_EQ(folder.read().notes, std::vector<std::string>{"1 depth map without a pose left out"});
  EXPECT_EQ(folder.complaintAbout(block(0, 5) + block(3, 7)),
            "/scene.log: line 6: expected the number of one of 3 depth maps, from 0, found 3");
  EXPECT_EQ(folder.complaintAbout(block(1, 5) + block(1, 7)),
            "/scene.log: line 6: expected one pose for every depth map, found another for number 1");
}

TEST(Open3d, JsonTrajectoryHasCamerasAndInversePoses) {
  const TinyFolder folder;
  std::filesystem::remove(folder.log());
  std::filesystem::remove(folder / "camera_primesense.json");
  const std::filesystem::path file = folder / "trajectory.json";
  writeText(file, R"({"parameters": [)" + parameter(1) + "," + parameter(2) + "," + parameter(3) + "]}");
  EXPECT_EQ(folder.x(1), -2);
  EXPECT_EQ(std::get<Pinhole>(folder.read().views.header(0).projection), (Pinhole{4, 3, 4, 5, 1.5, 1, {}}));
  writeText(file, R"({"parameters": [)" + parameter(1) + "]}");
  EXPECT_EQ(folder.complaint(),
            "/trajectory.json: parameters: expected 3 cameras as there are depth maps, found 1");
  writeText(file, R"({"parameters": [{"extrinsic": [1, 0]}]})");
  EXPECT_EQ(folder.complaint(), "/trajectory.json: parameters[0].extrinsic: expected 16 numbers, found 2");
  writeText(file, R"({"frames": []})");
  EXPECT_EQ(folder.complaint(), "/trajectory.json: expected a field 'parameters', found none");
}

TEST(Open3d, IntrinsicsCanBeGivenInPlaceOfAFile) {
  const TinyFolder folder;
  std::filesystem::remove(folder / "camera_primesense.json");
  EXPECT_EQ(folder.complaint(),
            ": expected camera_intrinsic.json (or *intrinsic*.json), or --intrinsics, found none");
  ReadOptions options;
  options.intrinsics = {{5, 6, 1, 2}};
  EXPECT_EQ(std::get<Pinhole>(folder.read(options).views.header(0).projection),
            (Pinhole{4, 3, 5, 6, 1, 2, {}}));
}

TEST(Open3d, BrokenTrajectoriesAreRefusedWithTheirLine) {
  const TinyFolder folder;
  EXPECT_EQ(folder.complaintAbout("0 0\n1 0 0 0\n"),
            "/scene.log: line 1: expected a line of three whole numbers, found the end of the line");
  EXPECT_EQ(folder.complaintAbout("0 0 x\n"),
            "/scene.log: line 1: expected a line of three whole numbers, found 'x'");
  EXPECT_EQ(folder.complaintAbout("0 0 1\n1 0 0 nan\n"),
            "/scene.log: line 2: expected a finite number, found nan");
  EXPECT_EQ(folder.complaintAbout("0 0 1\n1 0 0 0\n0 1 0 0\n"),
            "/scene.log: line 4: expected a number, found the end of the file");
  EXPECT_EQ(folder.complaintAbout("0 0 1\n\n2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"),
            "/scene.log: line 2: expected a rotation, found a matrix R with |RᵀR - 1| = 3");
  EXPECT_EQ(folder.complaintAbout(""), "/scene.log: expected the pose of a depth map, found none");
  writeText(folder / "other.log", "");
  EXPECT_EQ(folder.complaint(), ": expected trajectory.log or one *.log, found other.log and scene.log");
}

TEST(Open3d, MissingFilesAreNamed) {
  const TinyFolder folder;
  writeText(folder / "camera_primesense.json", R"({"width": 8, "height": 0})");
  EXPECT_EQ(folder.complaint(),
            "/camera_primesense.json: height: expected a whole number from 1 to 1048576, found 0");
  std::filesystem::remove(folder.log());
  EXPECT_EQ(folder.complaint(), ": expected trajectory.log or trajectory.json, found neither");
  std::filesystem::remove_all(folder / "depth");
  EXPECT_EQ(folder.complaint(), ": expected depth maps (depth/*.png), found none");
}

TEST(Open3d, CamerasThatDifferAreWrittenAsJson) {
  const TemporaryFolder folder;
  std::vector<View> truth = test::tinyViews();
  std::get<Pinhole>(truth[1].projection).fx = 30;
  writeDepthSet(folder / "set", "open3d", ViewSequence::fromViews(truth));
  EXPECT_TRUE(std::filesystem::exists(folder / "set/trajectory.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "set/trajectory.log"));
  test::expectSameViews(readDepthSet(folder / "set").views, truth, 0.00051);
}

}  // namespace
}  // namespace vdbfuse
