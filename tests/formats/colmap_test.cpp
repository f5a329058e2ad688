// SPDX-License-Identifier: Apache-2.0
#include "formats/colmap.h"

#include <gtest/gtest.h>

#include <string>

#include "formats/colmap_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

// A workspace of one image of 4x3 pixels at depth 2, as text.
struct TinyFolder : TemporaryFolder {
  TinyFolder() {
    std::filesystem::create_directories(*this / "sparse");
    std::filesystem::create_directories(*this / "stereo/depth_maps");
    writeText(cameras(), "1 PINHOLE 4 3 4 5 2 1.5\n");
    writeText(images(), "1 1 0 0 0 1 2 3 1 a.png\n\n");
    writeText(depth(), test::colmapMap(Image<float>(4, 3, 2.0F)));
  }
  std::filesystem::path cameras() const { return *this / "sparse/cameras.txt"; }
  std::filesystem::path images() const { return *this / "sparse/images.txt"; }
  std::filesystem::path depth() const { return *this / "stereo/depth_maps/a.png.geometric.bin"; }
  DepthSet read(const ReadOptions& options = {}) const { return readColmap(path(), options); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
  std::string complaintAbout(const std::filesystem::path& file, const std::string& text) const {
    const std::string good = readText(file);
    writeText(file, text);
    std::string message = complaint();
    writeText(file, good);
    return message;
  }
};

Pinhole cameraOf(const DepthSet& set) { return std::get<Pinhole>(set.views.header(0).projection); }

TEST(Colmap, TextAndBinaryModelsGiveTheSameViews) {
  for (const auto write : {test::writeColmapTextSample, test::writeColmapRigSample}) {
    const TemporaryFolder folder;
    write(folder.path());
    std::vector<View> truth = test::tinyViews();
    if (write == test::writeColmapRigSample) std::swap(truth[1], truth[2]);  // ordered by name
    test::expectSameViews(readColmap(folder.path(), {}).views, truth, 0);
  }
}

TEST(Colmap, RigsAreReadAndPhotometricMapsNoted) {
  const TemporaryFolder folder;
  test::writeColmapRigSample(folder.path());
  const DepthSet set = readColmap(folder.path(), {});
  EXPECT_EQ(set.views.header(2).name, "cam2/1");
  EXPECT_EQ(set.notes, std::vector<std::string>{
                           "1 photometric depth map in place of a geometric one, which is missing"});
}

TEST(Colmap, PoseOfTheFrameCountsWhereTheImageHasAnother) {
  const TinyFolder folder;
  writeText(folder / "sparse/rigs.txt", "# rigs\n3 2 CAMERA 9 CAMERA 1 1 1 0 0 0 0 0 -1\n");
  writeText(folder / "sparse/frames.txt", "8 3 1 0 0 0 5 0 0 1 CAMERA 1 1\n");
  const DepthSet set = folder.read();
  EXPECT_TRUE(set.views.header(0).world_from_camera.translation().isApprox(Eigen::Vector3d(-5, 0, 1)));
  EXPECT_EQ(set.notes,
            std::vector<std::string>{"1 image whose pose in its frame is another than in the list of images; "
                                     "the frame's is taken"});
  writeText(folder / "sparse/frames.txt", "8 4 1 0 0 0 5 0 0 1 CAMERA 1 1\n");
  EXPECT_EQ(folder.complaint(), "/sparse/frames.txt: line 1: expected one of the rigs, found rig 4");
}

TEST(Colmap, CameraModelsBecomePinholes) {
  const TinyFolder folder;
  const auto read = [&](const std::string& model) {
    writeText(folder.cameras(), "1 " + model);
    return cameraOf(folder.read());
  };
  EXPECT_EQ(read("PINHOLE 8 6 8 10 4 3"), (Pinhole{4, 3, 4, 5, 1.5, 1, {}}));
  EXPECT_EQ(read("SIMPLE_PINHOLE 4 3 4 2 1.5"), (Pinhole{4, 3, 4, 4, 1.5, 1, {}}));
  EXPECT_EQ(read("SIMPLE_RADIAL 4 3 4 2 1.5 0.1"), (Pinhole{4, 3, 4, 4, 1.5, 1, {0.1, 0, 0, 0, 0}}));
  EXPECT_EQ(read("RADIAL 4 3 4 2 1.5 0.1 0.2"), (Pinhole{4, 3, 4, 4, 1.5, 1, {0.1, 0.2, 0, 0, 0}}));
  EXPECT_EQ(read("OPENCV 4 3 4 5 2 1.5 .1 .2 .3 .4"), (Pinhole{4, 3, 4, 5, 1.5, 1, {.1, .2, .3, .4, 0}}));
  EXPECT_EQ(read("FULL_OPENCV 4 3 4 5 2 1.5 .1 .2 .3 .4 .5 0 0 0"),
            (Pinhole{4, 3, 4, 5, 1.5, 1, {.1, .2, .3, .4, .5}}));
}

TEST(Colmap, OtherCameraModelsAreRefusedByName) {
  const TinyFolder folder;
  EXPECT_EQ(folder.complaintAbout(folder.cameras(), "1 FOV 4 3 4 5 2 1.5 1\n"),
            "/sparse/cameras.txt: line 1: expected a camera SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, "
            "OPENCV or FULL_OPENCV, found FOV");
  EXPECT_EQ(folder.complaintAbout(folder.cameras(), "1 FULL_OPENCV 4 3 4 5 2 1.5 0 0 0 0 0 0.5 0 0\n"),
            "/sparse/cameras.txt: line 1: expected k4, k5 and k6 of 0, found 0.5");
}

TEST(Colmap, OptionsAreObeyed) {
  const TinyFolder folder;
  ReadOptions options;
  options.depth_scale = 3;
  options.intrinsics = {{7, 8, 1, 2}};
  EXPECT_EQ(folder.read(options).views.load(0).map.depth(0, 0), 6.0F);
  EXPECT_EQ(cameraOf(folder.read(options)), (Pinhole{4, 3, 7, 8, 1, 2, {}}));
}

TEST(Colmap, BrokenTextIsRefusedWithItsLine) {
  const TinyFolder folder;
  const auto images = [&](const std::string& text) { return folder.complaintAbout(folder.images(), text); };
  EXPECT_EQ(folder.complaintAbout(folder.cameras(), "# x\n1 PINHOLE 4 3 4 5 2\n"),
            "/sparse/cameras.txt: line 2: expected a number, found the end of the line");
  EXPECT_EQ(folder.complaintAbout(folder.cameras(), "1 PINHOLE 4 -3 4 5 2 1\n"),
            "/sparse/cameras.txt: line 1: expected a whole number, found '-3'");
  EXPECT_EQ(folder.complaintAbout(folder.cameras(), "1 PINHOLE 4 99999999 4 5 2 1\n"),
            "/sparse/cameras.txt: line 1: expected a size of 1 to 1048576 pixels, found 99999999");
  EXPECT_EQ(images("1 1 0 0 nan 1 2 3 1 a.png\n\n"),
            "/sparse/images.txt: line 1: expected a finite number, found nan");
  EXPECT_EQ(images("1 0 0 0 0 1 2 3 1 a.png\n\n"),
            "/sparse/images.txt: line 1: expected a quaternion of length 1, found 0");
  EXPECT_EQ(images("1 1 0 0 0 1 2 3 2 a.png\n\n"),
            "/sparse/images.txt: line 1: expected one of the cameras, found camera 2");
  EXPECT_EQ(images("1 1 0 0 0 1 2 3 1 ../../a.png\n\n"),
            "/sparse/images.txt: image 1: expected a path inside the data set, found "
            "'../../a.png.geometric.bin'");
  EXPECT_EQ(images("1 1 0 0 0 1 2 3 1 b.png\n\n"),
            "/stereo/depth_maps: expected depth maps of the images (NAME.geometric.bin), found none");
}

TEST(Colmap, BrokenBinariesAreRefusedWithTheirByte) {
  const TemporaryFolder folder;
  test::writeColmapRigSample(folder.path());
  const std::filesystem::path images = folder / "sparse/images.bin";
  const auto complaintAbout = [&](std::string text) {
    writeText(images, text);
    return messageOf<IoError>([&] { readColmap(folder.path(), {}); }).substr(images.string().size());
  };
  const std::string good = readText(images);
  EXPECT_EQ(complaintAbout(good.substr(0, 30)),
            ": byte 28: expected another field, found the end of the file");
  EXPECT_EQ(complaintAbout(good.substr(0, 5)), ": byte 0: expected another field, found the end of the file");
  std::string lying = good;
  lying.replace(good.find("0.png") + 6, 8, 8, '\x7f');  // number of points
  EXPECT_EQ(complaintAbout(lying),
            ": byte 91: expected 9187201950435737471 points of 24 bytes, found the end of the file");
}

TEST(Colmap, BrokenMapsAreRefused) {
  const TinyFolder folder;
  const auto complaint = [&](const std::string& text) { return folder.complaintAbout(folder.depth(), text); };
  const std::string name = "/stereo/depth_maps/a.png.geometric.bin: ";
  EXPECT_EQ(complaint("4&3&1&1234"), name + "expected 54 bytes for 4x3 pixels, found 10");
  EXPECT_EQ(complaint("4&3&3&1234"), name + "expected a map of one channel, found 3 channels");
  EXPECT_EQ(complaint("4&3;"), name + "byte 2: expected width&height&channels&, found something else");
  EXPECT_EQ(complaint("99999&9999999999&1&"),
            name + "expected an image of 1 to 268435456 pixels, found 99999x9999999999");
  EXPECT_EQ(complaint("P4"), name + "expected a PNG, PFM, EXR, NPY or TIFF file, found something else");
}

TEST(Colmap, MissingModelAndImagesWithoutDepthAreSaid) {
  const TinyFolder folder;
  writeText(folder.images(), "1 1 0 0 0 1 2 3 1 a.png\n\n2 1 0 0 0 1 2 3 1 b.png\n\n");
  EXPECT_EQ(folder.read().notes, std::vector<std::string>{"1 image without a depth map left out"});
  std::filesystem::remove(folder.cameras());
  EXPECT_EQ(folder.complaint(),
            ": expected a model in sparse/ (cameras and images, .bin or .txt), found none");
}

TEST(Colmap, WrittenWorkspaceHasWhatStereoFusionReads) {
  const TemporaryFolder folder;
  std::vector<View> truth = test::tinyViews(2);
  truth[0].map.color = Image<Rgb8>(48, 36, Rgb8{1, 2, 3});
  writeDepthSet(folder / "set", "colmap", ViewSequence::fromViews(truth));
  EXPECT_EQ(readText(folder / "set/stereo/fusion.cfg"), "0.png\n1.png\n");
  EXPECT_EQ(readText(folder / "set/sparse/cameras.txt"),
            "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n1 PINHOLE 48 36 45 46.5 24.5 18\n"
            "2 PINHOLE 24 18 22.5 23.25 12.25 9\n");
  const std::string normals = readText(folder / "set/stereo/normal_maps/1.png.geometric.bin");
  EXPECT_EQ(normals.size(), std::string("24&18&3&").size() + 3 * 4 * 24 * 18);
  const std::string points = readText(folder / "set/sparse/points3D.txt");
  EXPECT_GT(std::count(points.begin(), points.end(), '\n'), 100);
  test::expectSameViews(readDepthSet(folder / "set").views, truth, 0);
}

}  // namespace
}  // namespace vdbfuse
