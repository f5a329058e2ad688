// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/pfm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

Image<float> ramp() {
  Image<float> image(3, 2);
  float value = 0.25f;
  for (float& pixel : image) pixel = value *= -1.5f;
  return image;
}

std::string messageFor(const std::filesystem::path& path, const std::string& content) {
  writeText(path, content);
  const std::string message = messageOf<IoError>([&] { readPfm(path); });
  EXPECT_EQ(messageOf<IoError>([&] { readPfmHeader(path); }), message);
  EXPECT_EQ(message.find(path.string() + ": "), 0u);
  return message.substr(path.string().size() + 2);
}

TEST(Pfm, ImageComesBackAsItWas) {
  const TemporaryFolder folder;
  writePfm(folder / "a.pfm", ramp());
  EXPECT_EQ(readPfm(folder / "a.pfm"), ramp());
  EXPECT_EQ(readPfmHeader(folder / "a.pfm").width, 3);
  EXPECT_EQ(readPfmHeader(folder / "a.pfm").height, 2);
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(Pfm, BottomRowComesFirst) {
  const TemporaryFolder folder;
  using namespace std::string_literals;
  writeText(folder / "a.pfm", "Pf\n1 2\n-1\n\0\0\x80\x3f\0\0\0\x40"s);  // 1, then 2
  const Image<float> image = readPfm(folder / "a.pfm");
  EXPECT_EQ(image(0, 1), 1.0f);
  EXPECT_EQ(image(0, 0), 2.0f);
}

TEST(Pfm, PositiveScaleMeansMostSignificantByteFirst) {
  const TemporaryFolder folder;
  using namespace std::string_literals;
  writeText(folder / "a.pfm", "Pf\n1 2\n1.000000\n\x3f\x80\0\0\x40\0\0\0"s);
  const Image<float> image = readPfm(folder / "a.pfm");
  EXPECT_EQ(image(0, 1), 1.0f);
  EXPECT_EQ(image(0, 0), 2.0f);
}

TEST(Pfm, PixelsThatLookLikeBlanksAreNotSkipped) {
  const TemporaryFolder folder;
  writeText(folder / "a.pfm", "Pf 1 1 -1\n\n\n  ");  // the pixel's bytes are 0a 0a 20 20
  const float pixel = readPfm(folder / "a.pfm")(0, 0);
  EXPECT_GT(pixel, 0.0f);
  EXPECT_LT(pixel, 1e-18f);
}

TEST(Pfm, NumbersThatAreNotFiniteAreKept) {
  const TemporaryFolder folder;
  writePfm(folder / "a.pfm", Image<float>(2, 2, std::numeric_limits<float>::quiet_NaN()));
  EXPECT_TRUE(std::isnan(readPfm(folder / "a.pfm")(1, 0)));
}

TEST(Pfm, TruncatedFileIsRefusedWhereverItIsCut) {
  const TemporaryFolder folder;
  writePfm(folder / "good.pfm", ramp());
  const std::string good = readText(folder / "good.pfm");
  for (std::size_t size = 0; size < good.size(); ++size) {
    writeText(folder / "cut.pfm", good.substr(0, size));
    EXPECT_THROW(readPfm(folder / "cut.pfm"), IoError) << size;
  }
  EXPECT_EQ(messageFor(folder / "cut.pfm", good.substr(0, 30)),
            "byte 30: expected 36 bytes for 3x2 pixels, found the end of the file");
}

TEST(Pfm, ImpossibleHeadersTakeNoMemory) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.pfm";
  EXPECT_EQ(messageFor(path, "Pf\n-3 2\n-1\n"), "byte 3: expected a width above 0, found '-3'");
  EXPECT_EQ(messageFor(path, "Pf\n3 0\n-1\n"), "byte 5: expected a height above 0, found '0'");
  EXPECT_EQ(messageFor(path, "Pf\n3 2.5\n-1\n"), "byte 5: expected a height above 0, found '2.5'");
  EXPECT_EQ(messageFor(path, "Pf\n4000000000 4000000000\n-1\n"),
            "byte 3: expected an image of 1 to 268435456 pixels, found 4000000000x4000000000");
  EXPECT_EQ(messageFor(path, "Pf\n99999999999999999999 1\n-1\n"),
            "byte 3: expected a width above 0, found '99999999999999999999'");
  EXPECT_EQ(messageFor(path, "Pf\n16000 16000\n-1\n"),
            "byte 18: expected 1024000018 bytes for 16000x16000 pixels, found the end of the file");
  EXPECT_EQ(messageFor(path, "Pf\n3 2\n0\n"),
            "byte 7: expected a scale other than 0, its sign the byte order, found '0'");
  EXPECT_EQ(messageFor(path, "Pf\n3 2\nnan\n"),
            "byte 7: expected a scale other than 0, its sign the byte order, found 'nan'");
  EXPECT_EQ(messageFor(path, "Pf\n3"), "byte 4: expected a height above 0, found nothing");
}

TEST(Pfm, OtherKindsOfFileAreNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.pfm";
  EXPECT_EQ(messageFor(path, "PF\n3 2\n-1\n"),
            "byte 0: expected a grey PFM file ('Pf'), found a colour one ('PF')");
  EXPECT_EQ(messageFor(path, ""), "byte 0: expected a PFM file ('Pf'), found another signature");
  EXPECT_EQ(messageFor(path, "P5\n3 2\n255\n"),
            "byte 0: expected a PFM file ('Pf'), found another signature");
}

}  // namespace
}  // namespace vdbfuse
