// SPDX-License-Identifier: Apache-2.0
#include "formats/numpy.h"

#include <gtest/gtest.h>

#include <string>

#include "formats/numpy_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::npyText;
using test::npzText;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

using Arrays = std::vector<std::pair<std::string, std::string>>;

std::string floats(const std::vector<double>& numbers) { return test::bytesOf<float>(numbers); }

const std::vector<double> kCamera = {4, 0, 1.5, 0, 5, 1, 0, 0, 1};
const std::vector<double> kPose = {0, 0, 1, 1, 0, 1, 0, 2, -1, 0, 0, 3};

// Two rows of three depths, one camera and one pose, as a file set.npz.
Arrays tinyArrays() {
  return {{"depth", npyText("<f4", "(2, 3)", floats({1, 2, 3, 0, -1, 6}))},
          {"K", npyText("<f4", "(3, 3)", floats(kCamera))},
          {"pose", npyText("<f4", "(3, 4)", floats(kPose))}};
}

struct TinyFile : TemporaryFolder {
  explicit TinyFile(const Arrays& arrays = tinyArrays()) { writeText(file(), npzText(arrays)); }
  std::filesystem::path file() const { return *this / "set.npz"; }
  DepthSet read(const ReadOptions& options = {}) const { return readNumpy(path(), options); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read().views.load(0); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string complaintAbout(const std::string& name, const std::string& array) {
  Arrays arrays = tinyArrays();
  for (auto& [key, bytes] : arrays) {
    if (key == name) bytes = array;
  }
  return TinyFile(arrays).complaint();
}

TEST(Numpy, OneFrameIsReadFromOneFile) {
  const TinyFile folder;
  const DepthSet set = readNumpy(folder.file(), {});
  ASSERT_EQ(set.views.size(), 1u);
  const View view = set.views.load(0);
  EXPECT_EQ(std::get<Pinhole>(view.projection), (Pinhole{3, 2, 4, 5, 1.5, 1, {}}));
  EXPECT_TRUE((view.world_from_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(2, 2, 3)));
  EXPECT_EQ(view.map.depth(2, 1), 6.0F);
  EXPECT_EQ(view.map.depth(1, 1), kInvalidDepth);
  EXPECT_EQ(set.reading.stored, "32-bit float array of numpy");
  EXPECT_TRUE(set.notes.empty());
}

TEST(Numpy, EveryLayoutGivesTheSameViews) {
  const std::vector<View> truth = test::tinyViews();
  for (const auto write : {test::writeVggtSample, test::writeCut3rSample, test::writeFrameFilesSample,
                           test::writeArrayFilesSample}) {
    const TemporaryFolder folder;
    write(folder.path());
    test::expectSameViews(readNumpy(folder.path(), {}).views, truth, 0.00051);
  }
}

TEST(Numpy, ConfidenceAndColourComeAlong) {
  Arrays arrays = tinyArrays();
  arrays.emplace_back("conf", npyText("<f4", "(2, 3, 1)", floats({1, 2, 3, 4, 5, 6})));
  arrays.emplace_back("images",
                      npyText("<f4", "(3, 1, 2)", floats({0, 0.2, 0.4, 0.6, 0.8, 2})));  // channels first
  const TinyFile folder(arrays);
  const DepthMap map = folder.read().views.load(0).map;
  EXPECT_EQ(map.confidence(1, 1), 5.0F);
  EXPECT_EQ(map.color(0, 0), (Rgb8{0, 102, 204}));
  EXPECT_EQ(map.color(1, 0), (Rgb8{51, 153, 255}));
  ReadOptions options;
  options.color = ReadOptions::Color::Skip;
  EXPECT_TRUE(folder.read(options).views.load(0).map.color.empty());
}

TEST(Numpy, PlainestNameCountsAndOthersAreNoted) {
  Arrays arrays = tinyArrays();
  arrays.insert(arrays.begin(), {"depths", npyText("<f4", "(2, 3)", floats({9, 9, 9, 9, 9, 9}))});
  const DepthSet set = TinyFile(arrays).read();
  EXPECT_EQ(set.notes, std::vector<std::string>{"arrays left out in favour of others: depths"});
}

TEST(Numpy, OptionsAreObeyed) {
  const TinyFile folder;
  ReadOptions options;
  options.depth_scale = 2;
  options.max_depth = 5;
  options.intrinsics = {{7, 8, 1, 2}};
  const View view = folder.read(options).views.load(0);
  EXPECT_EQ(view.map.depth(0, 0), 2.0F);
  EXPECT_EQ(view.map.depth(2, 0), kInvalidDepth);
  EXPECT_EQ(std::get<Pinhole>(view.projection), (Pinhole{3, 2, 7, 8, 1, 2, {}}));
  options = {};
  options.depth_kind = DepthKind::Inverse;
  EXPECT_EQ(folder.read(options).views.load(0).map.depth(1, 0), 0.5F);
}

TEST(Numpy, WholeNumbersAreMillimetresAndSaturatedOnesInvalid) {
  Arrays arrays = tinyArrays();
  arrays[0].second =
      npyText(">u2", "(2, 3)", std::string("\x03\xe8\xff\xff\x00\x00\x07\xd0\x00\x01\x00\x01", 12));
  const DepthMap map = TinyFile(arrays).read().views.load(0).map;
  EXPECT_FLOAT_EQ(map.depth(0, 0), 1.0F);
  EXPECT_EQ(map.depth(1, 0), kInvalidDepth);
  EXPECT_FLOAT_EQ(map.depth(0, 1), 2.0F);
}

TEST(Numpy, MissingArraysAreNamed) {
  Arrays arrays = tinyArrays();
  arrays.erase(arrays.begin() + 1);
  EXPECT_EQ(TinyFile(arrays).complaint(),
            ": expected an array of intrinsics (intrinsics, intrinsic, K, Ks, ...), or --intrinsics, found "
            "none");
  arrays = tinyArrays();
  arrays.pop_back();
  EXPECT_EQ(TinyFile(arrays).complaint(),
            ": expected an array of poses (world_from_camera, world_from_cam, cam2world, c2w, ... or "
            "camera_from_world, cam_from_world, world2cam, w2c, ...), found none");
  arrays.erase(arrays.begin());
  EXPECT_EQ(TinyFile(arrays).complaint(),
            ": expected an array of depths (depth, depths, depth_map, depth_maps, ...), found none");
}

TEST(Numpy, BrokenArraysAreRefusedWithTheirNames) {
  EXPECT_EQ(
      complaintAbout("depth", npyText("<f4", "(2, 900000)", floats({1, 2, 3}))),
      "/set.npz: array 'depth': expected as many numbers as the shape (2, 900000) has, found the end of "
      "the file");
  EXPECT_EQ(complaintAbout("depth", npyText("<f4", "(6,)", floats({1, 2, 3, 4, 5, 6}))),
            "/set.npz: array 'depth': expected (frames, rows, columns), found shape (6)");
  EXPECT_EQ(complaintAbout("depth", npyText("|O", "()", "pickled")),
            "/set.npz: array 'depth': expected floats or whole numbers of up to 8 bytes, found '|O'");
  EXPECT_EQ(complaintAbout("depth", npyText("<f4", "(0, 3)", "")),
            "/set.npz: array 'depth': expected an image of 1 to 268435456 pixels, found 3x0");
  EXPECT_EQ(complaintAbout("depth", npyText("<f4", "(2, 1, 3)", floats({1, 2, 3, 4, 5, 6}))),
            "/set.npz: array 'pose': expected 2 frames as there are depth maps, found shape (3, 4)");
  EXPECT_EQ(complaintAbout("K", npyText("<f4", "(1, 9)", floats(kCamera))),
            "/set.npz: array 'K': expected 3x3 matrices, found shape (1, 9)");
  EXPECT_EQ(complaintAbout("pose", npyText("<f4", "(3, 4)", floats({1, 0, 0, NAN, 0, 1, 0, 0, 0, 0, 1, 0}))),
            "/set.npz: array 'pose': expected finite numbers, found nan");
  EXPECT_EQ(complaintAbout("pose", npyText("<f4", "(3, 4)", floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0}))),
            "/set.npz: array 'pose': expected a rotation, found a matrix R with |RᵀR - 1| = 3");
}

TEST(Numpy, ArchivesThatLieAboutSizesAreRefused) {
  const TinyFile folder;
  std::string text = readText(folder.file());
  const std::size_t entry = text.find("PK\1\2");
  text.replace(entry + 24, 4, "\xff\xff\xff\x0f");  // uncompressed size in the directory
  writeText(folder.file(), text);
  EXPECT_EQ(folder.complaint(),
            "/set.npz: array 'depth': expected an array that fits into the file, found 268435455 bytes made "
            "of 152");
  text[entry + 10] = 12;  // bzip2
  writeText(folder.file(), text);
  EXPECT_EQ(folder.complaint(),
            "/set.npz: array 'depth': expected an array stored or deflated, found compression method 12");
  writeText(folder.file(), text.substr(0, text.size() - 3));
  EXPECT_EQ(
      folder.complaint().find("/set.npz: expected an archive of numpy arrays (.npz), found a broken one"),
      0u);
}

TEST(Numpy, ViewsOfSeveralSizesAreWrittenAsOneFileEach) {
  const TemporaryFolder folder;
  std::vector<View> truth = test::tinyViews();
  truth[1].projection = Pinhole{3, 2, 4, 5, 1.5, 1, {}};
  truth[1].map.depth = Image<float>(3, 2, 1.25F);
  truth[1].map.color = {};
  writeDepthSet(folder / "set", "numpy", ViewSequence::fromViews(truth));
  EXPECT_TRUE(std::filesystem::exists(folder / "set/2.npz"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "set"), {}), 3);
  test::expectSameViews(readDepthSet(folder / "set").views, truth, 0);
}

TEST(Numpy, SameViewsGiveTheSameBytesAndNoOtherFile) {
  const TemporaryFolder folder;
  for (const char* name : {"a", "b"})
    writeDepthSet(folder / name, "numpy", ViewSequence::fromViews(test::tinyViews()));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "a"), {}), 1);
  EXPECT_EQ(readText(folder / "a/depth_set.npz"), readText(folder / "b/depth_set.npz"));
}

}  // namespace
}  // namespace vdbfuse
