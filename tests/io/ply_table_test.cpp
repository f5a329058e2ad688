// SPDX-License-Identifier: Apache-2.0
#include "io/ply_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

using test::messageOf;
using testing::ElementsAre;

const std::filesystem::path kPath = "t.ply";
const std::string kHeader =
    "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info note two words\nelement other 1\nproperty uchar "
    "a\nelement point 2\nproperty float x\nproperty list uchar int ids\nproperty float y\nend_header\n";

std::vector<std::vector<PlyColumn>> read(const std::string& text, const std::vector<std::string>& names) {
  const std::array<PlySelection, 1> wanted = {{{"point", names}}};
  return readPlyTable(kPath, text, parsePlyHeader(kPath, text), wanted);
}

TEST(PlyTable, ColumnsAreThoseAskedForInTheirOrder) {
  const auto columns = read(kHeader + "9\n1 2 7 8 2\n3 0 4\n", {"y", "x", "ids"});
  EXPECT_THAT(columns[0][0].values, ElementsAre(2, 4));
  EXPECT_THAT(columns[0][1].values, ElementsAre(1, 3));
  EXPECT_TRUE(columns[0][1].ends.empty());
  EXPECT_THAT(columns[0][2].values, ElementsAre(7, 8));
  EXPECT_THAT(columns[0][2].ends, ElementsAre(2, 2));
}

TEST(PlyTable, BinaryIsReadInBothByteOrders) {
  std::string header = kHeader;
  header.replace(header.find("ascii"), 5, "binary_little_endian");
  const std::string little("\x09\0\0\x80\x3f\1\5\0\0\0\0\0\0\x40\0\0\x40\x40\0\0\0\x80\x40", 23);
  EXPECT_THAT(read(header + little, {"x"})[0][0].values, ElementsAre(1, 3));
  EXPECT_THAT(read(header + little, {"ids"})[0][0].values, ElementsAre(5));
  header.replace(header.find("little"), 6, "big");
  const std::string big("\x09\x3f\x80\0\0\1\0\0\0\5\x40\0\0\0\x40\x40\0\0\0\x40\x80\0\0", 23);
  EXPECT_THAT(read(header + big, {"y"})[0][0].values, ElementsAre(2, 4));
}

TEST(PlyTable, InfoLinesAreInTheHeader) {
  const PlyHeader header = parsePlyHeader(kPath, kHeader);
  EXPECT_EQ(header.info.at("num_cols"), "3");
  EXPECT_EQ(header.info.at("note"), "two");
  EXPECT_EQ(findElement(header, "nothing"), nullptr);
  EXPECT_EQ(findProperty(*findElement(header, "point"), "y")->type, PlyType::Float);
}

TEST(PlyTable, OfTwoPropertiesOfOneNameTheFirstCounts) {
  std::string text = kHeader;
  text.replace(text.find("float y"), 7, "float x");
  EXPECT_THAT(read(text + "9\n1 0 2\n3 0 4\n", {"x"})[0][0].values, ElementsAre(1, 3));
}

TEST(PlyTable, WhatIsMissingIsNamed) {
  EXPECT_EQ(messageOf<IoError>([] { read(kHeader, {"z"}); }),
            "t.ply: expected the property 'z' of the element 'point', found none of that name");
  std::string text = kHeader;
  text.replace(text.find("element point"), 13, "element dot");
  EXPECT_EQ(messageOf<IoError>([&] { read(text, {"x"}); }),
            "t.ply: expected the element 'point', found none of that name");
}

TEST(PlyTable, CountsThatTheFileCannotHoldAreRefused) {
  std::string text = kHeader + "9\n1 0 2\n";
  EXPECT_EQ(messageOf<IoError>([&] { read(text, {"x"}); }),
            "t.ply: line 12: expected 2 elements 'point', found room for 1");
  text = kHeader + "9\n1 200 2\n3 4 5\n6 7 8\n";
  EXPECT_EQ(messageOf<IoError>([&] { read(text, {"x"}); }),
            "t.ply: line 13: expected a list that fits the file, found 200 values");
}

}  // namespace
}  // namespace vdbfuse::io
