// SPDX-License-Identifier: Apache-2.0
#include "formats/bundler.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "formats/image_samples.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

// The camera looks along -z from (-1, -2, -3).
const std::string kCamera = "5 0 0\n1 0 0\n0 1 0\n0 0 1\n1 2 3\n", kTitle = "# Bundle file v0.3\n";

struct TinyFolder : TemporaryFolder {
  explicit TinyFolder(const std::string& text = kTitle + "1 0\n" + kCamera,
                      const std::string& list = "a.png\n") {
    writePng(*this / "a.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
    writeText(*this / "bundle.out", text);
    writeText(*this / "list.txt", list);
  }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { readBundler(path(), {}); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string complaintAbout(const std::string& text, const std::string& list = "a.png\n") {
  return TinyFolder(text, list).complaint();
}

TEST(Bundler, CameraLooksAlongItsNegativeZWithYUp) {
  const TinyFolder folder;
  const PhotographHeader header = readBundler(folder / "bundle.out", {}).photographs.header(0);
  EXPECT_EQ(header.camera, (Pinhole{4, 3, 5, 5, 1.5, 1, {}}));
  EXPECT_TRUE((header.world_from_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(-1, -2, -4)));
  EXPECT_TRUE((header.world_from_camera * Eigen::Vector3d(0, 1, 0)).isApprox(Eigen::Vector3d(-1, -3, -3)));
}

TEST(Bundler, PhotographsItDidNotFindAreLeftOut) {
  const TemporaryFolder folder;
  test::writeBundlerSample(folder.path());
  const ImageSet set = readBundler(folder.path(), {});
  EXPECT_EQ(set.photographs.size(), 4u);
  EXPECT_THAT(set.notes, testing::Contains("1 photograph without a camera left out"));
}

TEST(Bundler, BrokenFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(complaintAbout(kTitle + "1 0\n5 0 x\n"), "/bundle.out: line 3: expected a number, found 'x'");
  EXPECT_EQ(complaintAbout(kTitle + "1 0\n5 0 inf\n"),
            "/bundle.out: line 3: expected a finite number, found 'inf'");
  EXPECT_EQ(complaintAbout(kTitle + "-1 0\n"),
            "/bundle.out: line 2: expected a whole number from 0 to 2147483647, found '-1'");
  EXPECT_EQ(complaintAbout(kTitle + "1 1\n" + kCamera + "0 0 0\n9 9 9\n1 7 0 0 0\n"),
            "/bundle.out: line 10: expected a whole number from 0 to 0, found '7'");
  EXPECT_EQ(complaintAbout(kTitle + "1 1\n" + kCamera + "0 0 0\n"),
            "/bundle.out: line 9: expected a number, found the end of the file");
  EXPECT_EQ(complaintAbout(kTitle + "1 0\n" + kCamera, "a.png\nb.png\n"),
            "/list.txt: line 2: expected 1 picture, as there are cameras, found 2");
  EXPECT_EQ(complaintAbout(kTitle + "1 0\n" + kCamera, "/a.png\n"),
            "/list.txt: line 1: expected a path inside the data set, found '/a.png'");
  EXPECT_EQ(complaintAbout("# Bundle file v0.1\n"),
            "/bundle.out: line 1: expected '# Bundle file v0.3', found "
            "'# Bundle file v0.1'");
}

TEST(Bundler, ListIsNeeded) {
  const TinyFolder folder;
  std::filesystem::remove(folder / "list.txt");
  EXPECT_EQ(folder.complaint(), "/list.txt: expected a list of the pictures, found nothing of that name");
  EXPECT_EQ(bundlerImageFormat().detect(folder.path()).reason, "bundle.out, but no list.txt");
}

}  // namespace
}  // namespace vdbfuse
