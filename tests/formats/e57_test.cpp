// SPDX-License-Identifier: Apache-2.0
// No other program that reads or writes E57 is at hand: the files are made by e57_writer.h, which shares
// nothing with the reader; both follow two open implementations (libE57Format, the crate e57).
#include "formats/e57.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "formats/e57_pages.h"
#include "formats/e57_writer.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::e57File;
using test::E57Part;
using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

// The logical bytes of a file.
std::string logical(const std::string& file) {
  std::string bytes;
  for (std::size_t i = 0; i < file.size(); i += 1024) bytes += file.substr(i, 1020);
  return bytes;
}

struct File : TemporaryFolder {
  explicit File(const std::string& bytes) { write(bytes); }
  explicit File(const std::vector<E57Part>& parts) : File(e57File(parts)) {}
  void write(const std::string& bytes) const { writeText(*this / "a.e57", bytes); }
  // Changes logical bytes and makes the checksums right again.
  void change(const std::string& from, const std::string& to) const {
    write(test::e57Pages(replaced(logical(readText(*this / "a.e57")), from, to)));
  }
  DepthSet read(const ReadOptions& options = {}) const { return readE57(*this / "a.e57", options); }
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); }), path = (*this / "a.e57").string();
    return message.starts_with(path) ? message.substr(path.size()) : message;
  }
};

std::vector<E57Part> partsOf(E57Part (*make)(const View&)) {
  std::vector<E57Part> parts;
  for (const View& view : make == test::loosePart ? test::tinyDenseScans() : test::tinySphericalViews())
    parts.push_back(make(view));
  return parts;
}

// A scan of sixteen by four points all in view, small enough for one page or two.
E57Part smallPart() {
  View view;
  view.name = "s";
  view.projection = Spherical{16, 4, -0.8, 0.1, 0.1, 0.1};
  view.map.depth = Image<float>(16, 4, 3.0F);
  E57Part part = test::cartesianPart(view);
  part.pose = RigidTransform::Identity();
  return part;
}

TEST(E57, ChecksumIsThatOfCastagnoli) {
  EXPECT_EQ(io::crc32c("123456789"), 0xE3069283U);
  EXPECT_EQ(io::crc32c(std::string(32, '\0')), 0x8A9136AAU);  // RFC 3720
}

TEST(E57, CartesianScansWithRowsAndColumnsAreImages) {
  const File file(partsOf(test::cartesianPart));
  const DepthSet set = file.read();
  test::expectSameViews(set.views, test::tinySphericalViews(), 2e-6);
  EXPECT_EQ(set.views.header(1).name, "scan 1");
  EXPECT_EQ(set.reading.stored, "x y z as 32-bit floats");
  EXPECT_THAT(set.notes, testing::ElementsAre("colours of 2 scans left out"));
}

TEST(E57, SphericalScaledIntegersAreTheSame) {
  const File file(partsOf(test::sphericalPart));
  const DepthSet set = file.read();
  test::expectSameViews(set.views, test::tinySphericalViews(), 6e-5);
  EXPECT_EQ(set.views.header(0).name, "scan_1");
  EXPECT_EQ(set.reading.stored, "range, azimuth and elevation as 20-bit integers");
}

TEST(E57, LooseDoublesAreSplatted) {
  const File file(partsOf(test::loosePart));
  const DepthSet set = file.read();
  test::expectOnSurface(set.views, 0.02, 0.1);
  EXPECT_THAT(set.notes, testing::ElementsAre(testing::HasSubstr("2 scans made into spherical depth maps")));
}

TEST(E57, ScanThatFillsLittleOfItsRowsAndColumnsIsLoose) {
  E57Part part = smallPart();
  part.columns[1].maximum = 1000000, part.columns[1].values.back() = 999999;
  EXPECT_THAT(File({part}).read().notes, testing::Contains(testing::HasSubstr("1 scan made into")));
}

TEST(E57, PoseMayBeMissingOfASingleScanOnly) {
  E57Part part = smallPart();
  part.pose.reset();
  const File file({part});
  const DepthSet set = file.read();
  EXPECT_THAT(set.notes, testing::Contains("no pose: the scanner is taken to be the world's origin"));
  EXPECT_TRUE(set.views.header(0).world_from_camera.translation().isZero());
  EXPECT_EQ(File({smallPart(), part}).complaint(),
            ": data3D[1]: expected a pose, as the file has several scans, found none");
}

TEST(E57, ScansWithoutPointsAreLeftOut) {
  E57Part empty = smallPart();
  for (test::E57Column& column : empty.columns) column.values.clear();
  const File file({empty, smallPart()});
  const DepthSet set = file.read();
  EXPECT_EQ(set.views.size(), 1U);
  EXPECT_THAT(set.notes, testing::Contains("1 scan without points left out"));
  EXPECT_EQ(File({empty}).complaint(), ": data3D: expected a scan with points, found none");
}

TEST(E57, OfSeveralReturnsAtAPixelTheNearestIsTaken) {
  E57Part part = smallPart();
  for (test::E57Column& column : part.columns) column.values.push_back(column.values.front());
  for (const std::size_t i : {3, 4, 5}) part.columns[i].values.back() *= 0.5;
  const File file({part});
  EXPECT_NEAR(file.read().views.load(0).map.depth(0, 0), 1.5, 1e-6);
}

TEST(E57, LimitsAndScaleAreObeyedAndCamerasRefused) {
  const File file({smallPart()});
  ReadOptions options;
  options.depth_scale = 2;
  EXPECT_NEAR(file.read(options).views.load(0).map.depth(1, 1), 6, 1e-5);
  options.max_depth = 5;
  EXPECT_EQ(file.read(options).views.load(0).map.depth(1, 1), kInvalidDepth);
  options.intrinsics = {{1, 1, 0, 0}};
  EXPECT_THROW(file.read(options), InvalidArgument);
}

TEST(E57, BrokenHeadersAndPagesAreRefused) {
  const File file({smallPart()});
  const std::string good = readText(file / "a.e57");
  const auto complaintAbout = [&](const std::string& bytes) {
    file.write(bytes);
    return file.complaint();
  };
  std::string bad = good;
  bad[0] = 'B';
  EXPECT_EQ(complaintAbout(bad), ": byte 0: expected ASTM-E57, found another signature");
  EXPECT_EQ(complaintAbout(good.substr(0, 40)),
            ": byte 40: expected a header of 48 bytes, found the end of the file");
  bad = good, bad[8] = 2;
  EXPECT_EQ(complaintAbout(bad), ": byte 8: expected E57 version 1, found version 2");
  bad = good, bad[41] = 0;
  EXPECT_EQ(complaintAbout(bad), ": byte 40: expected pages of 64 to 1048576 bytes, found 0");
  EXPECT_EQ(complaintAbout(good.substr(0, 1024)),
            ": byte 16: expected the length of the file in whole pages, found " +
                std::to_string(good.size()) + " where the file has 1024 bytes");
  bad = good, bad[200] ^= 1;
  EXPECT_EQ(complaintAbout(bad),
            ": byte 1020: expected the checksum of page 0, found another: the file is damaged");
  bad = good, bad[24] = bad[25] = '\xFF';
  EXPECT_EQ(complaintAbout(bad), ": byte 65535: expected the XML section, found the end of the file");
  bad = good, bad[24] = '\xFE', bad[25] = 3;
  EXPECT_EQ(complaintAbout(bad), ": byte 1022: expected the XML section, found a checksum");
  bad = good, bad[39] = 1;
  EXPECT_EQ(complaintAbout(bad),
            ": byte 32: expected an XML section of at most 67108864 bytes, found " +
                std::to_string((std::uint64_t{1} << 56) + logical(good).find("</e57Root>") + 11 -
                               logical(good).find("<?xml")));
}

TEST(E57, BrokenXmlIsRefusedByTheNameOfItsElement) {
  const auto complaintAbout = [](const std::string& from, const std::string& to) {
    EXPECT_EQ(from.size(), to.size()) << to;
    const File file({smallPart()});
    file.change(from, to);
    return file.complaint();
  };
  EXPECT_THAT(
      complaintAbout("</prototype>", "</prototypo>"),
      testing::StartsWith(": the XML section: expected sound XML, found Start-end tags mismatch at its "));
  EXPECT_EQ(File(std::vector<E57Part>{}).complaint(), ": data3D: expected a scan, found none");
  EXPECT_EQ(complaintAbout("recordCount=\"64\"", "recordCount=\"6x\""),
            ": data3D[0]/points/recordCount: expected a whole number, found '6x'");
  EXPECT_EQ(
      complaintAbout("\"64\">\n<prototype type=\"Structure\">", "\"64123456789012345\">\n<prototype  >"),
      ": data3D[0]/points: expected no more records than the file has room for, found 64123456789012345 "
      "records");
  EXPECT_EQ(complaintAbout(">1</w>", ">2</w>"),
            ": data3D[0]/pose/rotation: expected a quaternion w x y z of length 1, found length 2");
  EXPECT_EQ(complaintAbout(">1</w><x type=\"Float\"/>", ">1</w><x>inf    </x>   "),
            ": data3D[0]/x: expected a finite number, found 'inf'");
  EXPECT_EQ(complaintAbout("translation type=\"Structure\"><x type=\"Float\"/>",
                           "translation                 ><x>?      </x>   "),
            ": data3D[0]/x: expected a finite number, found '?'");
  EXPECT_EQ(complaintAbout(">1</w>", ">?</w>"), ": data3D[0]/w: expected a finite number, found '?'");
  EXPECT_EQ(complaintAbout("<colorRed type=\"Integer\"", "<colorRed type=\"Vector\" "),
            ": data3D[0]/prototype/colorRed: expected a field that is one number, found a Vector");
  EXPECT_EQ(complaintAbout("maximum=\"255\"", "maximum=\"-55\""),
            ": data3D[0]/colorRed: expected a maximum that is not below the minimum, found -55");
}

TEST(E57, ScansThatTogetherClaimMoreThanTheFileHoldsAreRefused) {
  const std::string one = "recordCount=\"64\"", many = "recordCount=\"9999\"";
  const File file({smallPart(), smallPart()});
  std::string text = logical(readText(file / "a.e57"));
  const std::size_t length = text.find("</e57Root>") + 11 - text.find("<?xml");
  text = replaced(replaced(text, one, many), one, many);
  for (int i = 0; i < 8; ++i)
    text[32 + static_cast<std::size_t>(i)] = static_cast<char>((length + 4) >> (8 * i));
  file.write(test::e57Pages(text));
  EXPECT_THAT(file.complaint(),
              testing::EndsWith("]/points: expected no more records than the file has room for, "
                                "found 9999 records"));
}

TEST(E57, WhatIsNotCoveredIsRefusedByName) {
  E57Part part = smallPart();
  part.codecs = "<vectorChild><zlibCodec/></vectorChild>";
  EXPECT_EQ(File({part}).complaint(),
            ": data3D[0]/points/codecs: expected the bitpack codec, found 'zlibCodec'");
  part = smallPart();
  part.columns[4].name = "y";
  EXPECT_EQ(File({part}).complaint(),
            ": data3D[0]/points/prototype: expected numbers cartesianX, Y, Z or sphericalRange, Azimuth, "
            "Elevation, found no sphericalRange");
  part = smallPart();
  part.columns[4].type = test::E57Column::Type::Text;
  EXPECT_THAT(File({part}).complaint(), testing::EndsWith("found no number cartesianY"));
  part = smallPart();
  for (const std::size_t i : {3, 4, 5}) part.columns[i].type = test::E57Column::Type::Integer;
  EXPECT_THAT(File({part}).complaint(), testing::EndsWith("found no coordinate that takes a bit"));
}

TEST(E57, BrokenSectionsAreRefusedWithTheirByte) {
  const File file({smallPart()});
  const std::string good = logical(readText(file / "a.e57"));
  // Changes one logical byte.
  const auto complaintAbout = [&](std::size_t at, int byte) {
    std::string bad = good;
    bad[at] = static_cast<char>(byte);
    file.write(test::e57Pages(bad));
    return file.complaint();
  };
  EXPECT_EQ(complaintAbout(48, 0), ": byte 48: expected a section of points (1), found kind 0");
  EXPECT_EQ(complaintAbout(59, 1),
            ": byte 56: expected a section that ends in the file, found 16778292 bytes");
  EXPECT_EQ(complaintAbout(66, 1),
            ": byte 65616: expected the first packet of data3D[0], found the end of the file");
  EXPECT_EQ(complaintAbout(57, 0), ": byte 112: expected 64 records of data3D[0], found 0");
  EXPECT_EQ(complaintAbout(80, 9), ": byte 80: expected a packet of kind 0, 1 or 2, found kind 9");
  EXPECT_EQ(complaintAbout(82, 0x20),
            ": byte 80: expected a packet of a multiple of 4 bytes, found 33 bytes");
  EXPECT_EQ(complaintAbout(116, 6), ": byte 112: expected 7 bytestreams, found another number");
  EXPECT_EQ(complaintAbout(119, 9), ": byte 112: expected bytestreams inside their packet, found 3308 bytes");
  EXPECT_EQ(complaintAbout(115, 255),
            ": byte 112: expected a packet of 65516 bytes, found the end of the file");
}

}  // namespace
}  // namespace vdbfuse
