// SPDX-License-Identifier: Apache-2.0
#include "formats/middlebury.h"

#include <gtest/gtest.h>

#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

const std::string kLine = "a.png 4 0 1.5 0 5 1.25 0 0 1 0 -1 0 1 0 0 0 0 1 1 2 3\n";

struct TinyFolder : TemporaryFolder {
  explicit TinyFolder(const std::string& text = "1\n" + kLine) {
    writePng(*this / "a.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
    writeText(*this / "tiny_par.txt", text);
  }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { readMiddlebury(path(), {}); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string complaintAbout(const std::string& text) { return TinyFolder(text).complaint(); }

// The line with one of its words, counted from 0, in place of what it was.
std::string lineWith(std::size_t index, const std::string& word) {
  std::istringstream words(kLine);
  std::string line, next;
  for (std::size_t i = 0; words >> next; ++i) line += (i == 0 ? "" : " ") + (i == index ? word : next);
  return line + "\n";
}

TEST(Middlebury, FileGivesWorldToCamera) {
  const TinyFolder folder;
  for (const auto& path : {folder.path(), folder / "tiny_par.txt"}) {
    const PhotographHeader header = readMiddlebury(path, {}).photographs.header(0);
    EXPECT_EQ(header.name, "a");
    EXPECT_EQ(header.camera, (Pinhole{4, 3, 4, 5, 1.5, 1.25, {}}));
    // R (x, y, z) = (-y, x, z).
    const Eigen::Vector3d seen = header.world_from_camera.inverse() * Eigen::Vector3d(10, 20, 30);
    EXPECT_TRUE(seen.isApprox(Eigen::Vector3d(-20 + 1, 10 + 2, 30 + 3)));
  }
}

TEST(Middlebury, BrokenFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(complaintAbout(""),
            "/tiny_par.txt: line 1: expected the number of photographs, found the end of the file");
  EXPECT_EQ(complaintAbout(kLine),
            "/tiny_par.txt: line 1: expected the number of photographs, found 'a.png'");
  EXPECT_EQ(complaintAbout("2\n" + kLine), "/tiny_par.txt: line 3: expected 2 photographs, found 1");
  EXPECT_EQ(complaintAbout("1\n" + kLine + kLine), "/tiny_par.txt: line 3: expected 1 photograph, found 2");
  EXPECT_EQ(complaintAbout("1\na.png 1 2\n"),
            "/tiny_par.txt: line 2: expected the name of a picture and 21 numbers, found 3 words");
  EXPECT_EQ(complaintAbout("1\n" + lineWith(5, "x")),
            "/tiny_par.txt: line 2: expected a finite number, found 'x'");
  EXPECT_EQ(
      complaintAbout("1\n" + lineWith(2, "0.5")),
      "/tiny_par.txt: line 2: expected intrinsics without skew, found 0.5 and 0 beside the focal lengths");
  EXPECT_EQ(complaintAbout("1\n" + lineWith(18, "2")),
            "/tiny_par.txt: line 2: expected a rotation, found a matrix R with |RᵀR - 1| = 3");
  EXPECT_EQ(complaintAbout("1\n" + lineWith(0, "../a.png")),
            "/tiny_par.txt: line 2: expected a path inside the data set, found '../a.png'");
}

TEST(Middlebury, OneFileIsNeeded) {
  const TinyFolder folder;
  writeText(folder / "other_par.txt", "");
  EXPECT_EQ(folder.complaint(), ": expected one file *_par.txt, found 2");
  EXPECT_EQ(middleburyImageFormat().detect(folder.path()).reason, "2 files *_par.txt");
}

}  // namespace
}  // namespace vdbfuse
