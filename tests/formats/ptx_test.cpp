// SPDX-License-Identifier: Apache-2.0
// No other program that reads or writes PTX is at hand: the samples are spelled out from two descriptions (a
// page of P. Bourke, the reader of CloudCompare).
#include "formats/ptx.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "formats/ptx_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::ptxScan;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

// Eight columns of five rows around a scanner at (1, 2, 3), which looks along the world's y.
View scanView() {
  View view;
  view.name = "a";
  view.projection = Spherical{8, 5, -0.35, 0.1, 0.3, 0.05};
  view.world_from_camera.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  view.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  view.map.depth = Image<float>(8, 5, 2.0F);
  view.map.depth(3, 1) = kInvalidDepth;
  view.map.depth(7, 4) = 2.5F;
  return view;
}

struct ScanFile : TemporaryFolder {
  explicit ScanFile(const std::string& text = ptxScan(scanView(), false)) { write(text); }
  void write(const std::string& text) const { writeText(*this / "a.ptx", text); }
  DepthSet read(const ReadOptions& options = {}) const { return readPtx(*this / "a.ptx", options); }
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); }), path = (*this / "a.ptx").string();
    return message.starts_with(path) ? message.substr(path.size()) : message;
  }
  // The file with line `number` replaced.
  void replaceLine(int number, const std::string& line) const {
    std::string text = readText(*this / "a.ptx");
    std::size_t begin = 0;
    for (int i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
    write(text.replace(begin, text.find('\n', begin) - begin, line));
  }
};

TEST(Ptx, ScanIsReadUprightWithItsPose) {
  const ScanFile file;
  const DepthSet set = file.read();
  EXPECT_TRUE(set.notes.empty());
  test::expectSameViews(set.views, {scanView()}, 1e-5);
  const auto scanner = std::get<Spherical>(set.views.header(0).projection);
  EXPECT_NEAR(scanner.azimuth0, -0.35, 1e-6);
  EXPECT_NEAR(scanner.elevation_step, 0.05, 1e-6);
  EXPECT_EQ(set.views.header(0).name, "a");
}

TEST(Ptx, SeveralScansInOneFileAndSeveralFilesAreViews) {
  const TemporaryFolder folder;
  writeText(folder / "b.ptx", test::ptxOfTwoScans() + "\r\n\n");
  writeText(folder / "a.PTX", ptxScan(scanView(), false));
  const DepthSet set = readPtx(folder.path(), {});
  ASSERT_EQ(set.views.size(), 3U);
  EXPECT_EQ(set.views.header(0).name, "a");
  EXPECT_EQ(set.views.header(2).name, "b_2");
  EXPECT_THAT(set.notes, testing::ElementsAre("colours of 2 scans left out"));
}

TEST(Ptx, RowsFromAboveAndColumnsFromTheRightAreTurnedUpright) {
  View mirrored = scanView();
  mirrored.projection = Spherical{8, 5, 0.35, -0.1, 0.5, -0.05};
  std::swap(mirrored.map.depth(3, 1), mirrored.map.depth(4, 3));
  std::swap(mirrored.map.depth(7, 4), mirrored.map.depth(0, 0));
  test::expectSameViews(ScanFile(ptxScan(mirrored, false)).read().views, {scanView()}, 1e-5);
}

TEST(Ptx, PointsInTheWorldAreTakenBackToTheScanner) {
  const ScanFile file;
  View moved = scanView();
  std::string points = ptxScan(moved, false);
  const View view = scanView();
  std::ostringstream text;
  text << "8\n5\n1 2 3\n0 1 0\n-1 0 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 5; ++y) {
      const bool valid = view.map.depth(x, y) > 0;
      text << (valid ? worldPoint(view, x, y) : Eigen::Vector3d(0, 0, 0)).transpose() << " 1\n";
    }
  }
  file.write(text.str());
  const DepthSet set = file.read();
  EXPECT_THAT(set.notes,
              testing::ElementsAre("1 scan in other axes than the scanner's, taken back to its pose"));
  test::expectSameViews(set.views, {view}, 1e-4);
}

TEST(Ptx, ScannerAxesThatAreNoneAreIgnored) {
  const ScanFile file;
  for (int line = 3; line <= 6; ++line) file.replaceLine(line, "0 0 0");
  test::expectSameViews(file.read().views, {scanView()}, 1e-5);
}

TEST(Ptx, NumbersThatAreNotFiniteAreNoReturns) {
  const ScanFile file;
  file.replaceLine(11, "nan 0 0 1");
  file.replaceLine(12, "1e300 0 0 1");
  file.replaceLine(13, "inf -inf +0 1");
  const View view = file.read().views.load(0);
  EXPECT_EQ(view.map.depth(0, 4), kInvalidDepth);
  EXPECT_EQ(view.map.depth(0, 3), kInvalidDepth);
  EXPECT_EQ(view.map.depth(0, 2), kInvalidDepth);
  EXPECT_EQ(view.map.depth(0, 1), 2.0F);
}

TEST(Ptx, LimitsAndScaleAreObeyedAndCamerasRefused) {
  const ScanFile file;
  ReadOptions options;
  options.depth_scale = 2;
  options.max_depth = 4.5;
  const View view = file.read(options).views.load(0);
  EXPECT_NEAR(view.map.depth(0, 0), 4, 1e-5);
  EXPECT_EQ(view.map.depth(7, 4), kInvalidDepth);
  options.intrinsics = {{1, 1, 0, 0}};
  EXPECT_THROW(file.read(options), InvalidArgument);
}

TEST(Ptx, BrokenHeadersAreRefusedWithTheirLine) {
  const auto complaintAbout = [](int number, const std::string& line) {
    const ScanFile file;
    file.replaceLine(number, line);
    return file.complaint();
  };
  EXPECT_EQ(ScanFile("\n \n").complaint(), ": expected a scan, found an empty file");
  EXPECT_EQ(complaintAbout(1, "x"), ": line 1: expected the number of columns, found 'x'");
  EXPECT_EQ(complaintAbout(2, "5.5"), ": line 2: expected the number of rows, found '5.5'");
  EXPECT_EQ(complaintAbout(2, "-5"), ": line 2: expected an image of 1 to 268435456 pixels, found 8x-5");
  EXPECT_EQ(complaintAbout(2, "9000000000000000000"),
            ": line 2: expected an image of 1 to 268435456 pixels, found 8x9000000000000000000");
  EXPECT_EQ(complaintAbout(3, "1 2"), ": line 3: expected the scanner's position x y z, found '1 2'");
  EXPECT_EQ(complaintAbout(4, "1 2 3 4"), ": line 4: expected an axis of the scanner x y z, found '1 2 3 4'");
  EXPECT_EQ(complaintAbout(8, "0 nan 0 0"), ": line 8: expected a row of the 4x4 matrix, found '0 nan 0 0'");
  EXPECT_EQ(complaintAbout(10, "1 2 3 0"),
            ": line 7: expected a pose whose last row is 0 0 0 1, found 0 0 0 0");
  EXPECT_EQ(complaintAbout(9, "0 0 2 0"),
            ": line 7: expected a rotation, found a matrix R with |RᵀR - 1| = 3");
}

TEST(Ptx, MissingOrBrokenPointsAreRefusedWithTheirLine) {
  const ScanFile file;
  const std::string text = readText(file / "a.ptx");
  file.replaceLine(20, "1 2 three 0.5");
  EXPECT_EQ(file.complaint(), ": line 20: expected x y z and an intensity, found '1 2 three 0.5'");
  file.write(text.substr(0, text.size() - 3));
  EXPECT_EQ(file.read().views.size(), 1U);
  file.write(text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  EXPECT_EQ(file.complaint(), ": line 50: expected 40 points of a 8x5 scan, found the end of the file");
  file.replaceLine(1, "8000");
  EXPECT_THAT(file.complaint(),
              testing::StartsWith(": line 11: expected 40000 points of a 8000x5 scan, found "));
  file.write(text + "8\n");
  EXPECT_EQ(file.complaint(), ": line 52: expected the number of rows, found the end of the file");
  file.write(std::string(200000, '7'));
  EXPECT_EQ(file.complaint(),
            ": line 1: expected a line of text, found more than 65536 bytes without an end of line");
}

TEST(Ptx, FileThatChangesAfterItWasOpenedIsRefused) {
  const ScanFile file;
  const DepthSet set = file.read();
  file.write("8\n5\n");
  EXPECT_THROW(set.views.load(0), IoError);
}

TEST(Ptx, TurningScannersAreWrittenToo) {
  const TemporaryFolder folder;
  const std::vector<View> truth = test::tinySphericalViews();
  writeDepthSet(folder / "set", "ptx", ViewSequence::fromViews(truth));
  test::expectSameViews(readDepthSet(folder / "set").views, truth, 1e-5);
  EXPECT_EQ(readText(folder / "set/0.ptx").substr(0, 6), "40\n16\n");
}

TEST(Ptx, OtherSensorsAreNotWritten) {
  const TemporaryFolder folder;
  View view = scanView();
  view.projection = Orthographic{8, 5, 0, 1, 0, 1};
  EXPECT_EQ(messageOf<InvalidArgument>(
                [&] { writeDepthSet(folder / "set", "ptx", ViewSequence::fromViews({view})); }),
            "view a: the format ptx holds pinholes without distortion only");
}

}  // namespace
}  // namespace vdbfuse
