// SPDX-License-Identifier: Apache-2.0
#include "formats/strecha.h"

#include <gtest/gtest.h>

#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

const std::string kCamera = "4 0 1.5\n0 5 1.25\n0 0 1\n0 0 0\n0 -1 0\n1 0 0\n0 0 1\n1 2 3\n4 3\n";

struct TinyFolder : TemporaryFolder {
  explicit TinyFolder(const std::string& text = kCamera) {
    writePng(*this / "a.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
    writeText(*this / "a.png.camera", text);
  }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { readStrecha(path(), {}); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string complaintAbout(std::string text, const std::string& good, const std::string& bad) {
  return TinyFolder(text.replace(text.find(good), good.size(), bad)).complaint();
}

void expectTheCamera(const ImageSet& set) {
  ASSERT_EQ(set.photographs.size(), 1u);
  const PhotographHeader& header = set.photographs.header(0);
  EXPECT_EQ(header.name, "a");
  EXPECT_EQ(header.camera, (Pinhole{4, 3, 4, 5, 1.5, 1.25, {}}));
  // x = K Rᵀ (X − C): R takes the camera's x to the world's y.
  EXPECT_TRUE((header.world_from_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
}

TEST(Strecha, RotationIsCameraToWorld) { expectTheCamera(readStrecha(TinyFolder().path(), {})); }

TEST(Strecha, CamerasMayLieInAFolderOfTheirOwn) {
  const TemporaryFolder folder;
  for (const char* name : {"images", "cameras"}) std::filesystem::create_directory(folder / name);
  writePng(folder / "images/a.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
  writeText(folder / "cameras/a.png.camera", kCamera);
  expectTheCamera(readStrecha(folder.path(), {}));
}

TEST(Strecha, BrokenFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(
      complaintAbout(kCamera, "4 0 1.5", "4 1 1.5"),
      "/a.png.camera: line 1: expected intrinsics without skew, found 1 and 0 beside the focal lengths");
  EXPECT_EQ(complaintAbout(kCamera, "0 0 0\n", "0.1 0 0\n"),
            "/a.png.camera: line 4: expected three zeros (no distortion), found other numbers");
  EXPECT_EQ(complaintAbout(kCamera, "0 -1 0\n", "0 -1\n"),
            "/a.png.camera: line 5: expected a 3x3 rotation, world_from_camera, found 2 numbers in a row");
  EXPECT_EQ(complaintAbout(kCamera, "0 -1 0\n", "0 1 0\n"),
            "/a.png.camera: line 5: expected a rotation, found a matrix with determinant -1");
  EXPECT_EQ(complaintAbout(kCamera, "4 3\n", "4 -3\n"),
            "/a.png.camera: line 9: expected a size of 1 to 1048576 pixels, found -3");
  EXPECT_EQ(complaintAbout(kCamera, "\n4 3\n", "\n"),
            "/a.png.camera: line 9: expected width and height, found the end of the file");
}

}  // namespace
}  // namespace vdbfuse
