// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/png.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

template <class T, class Value>
Image<T> filled(int width, int height, const Value& value) {
  Image<T> image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image(x, y) = value(x, y);
  }
  return image;
}

Image<std::uint16_t> depthLike() {
  return filled<std::uint16_t>(19, 7,
                               [](int x, int y) { return static_cast<std::uint16_t>(x * 3001 + y * 257); });
}

Image<Rgb8> colourful() {
  return filled<Rgb8>(5, 9, [](int x, int y) {
    return Rgb8{static_cast<std::uint8_t>(50 * x), static_cast<std::uint8_t>(25 * y), 7};
  });
}

TEST(Png, SixteenBitsComeBackAsTheyWere) {
  const TemporaryFolder folder;
  writePng(folder / "a.png", depthLike());
  EXPECT_EQ(readPngGrey16(folder / "a.png"), depthLike());
}

TEST(Png, SixteenBitsAreStoredMostSignificantByteFirst) {
  const TemporaryFolder folder;
  // Written by another program: 1x1, 16-bit grey, value 0x0102.
  const unsigned char bytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
      0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x10, 0x00, 0x00, 0x00, 0x00, 0x6a, 0xee, 0x47, 0x16, 0x00,
      0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x64, 0x02, 0x00, 0x00, 0x07, 0x00,
      0x04, 0x76, 0x49, 0xe3, 0x28, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  writeText(folder / "a.png", std::string(reinterpret_cast<const char*>(bytes), sizeof(bytes)));
  EXPECT_EQ(readPngGrey16(folder / "a.png")(0, 0), 0x0102);
}

TEST(Png, EightBitsAndColourComeBackAsTheyWere) {
  const TemporaryFolder folder;
  const auto grey =
      filled<std::uint8_t>(4, 3, [](int x, int y) { return static_cast<std::uint8_t>(60 * x + y); });
  writePng(folder / "grey.png", grey);
  EXPECT_EQ(readPngGrey8(folder / "grey.png"), grey);
  writePng(folder / "colour.png", colourful());
  EXPECT_EQ(readPngRgb(folder / "colour.png"), colourful());
}

TEST(Png, GreyIsReadAsColourOfEqualParts) {
  const TemporaryFolder folder;
  writePng(folder / "a.png", Image<std::uint8_t>(2, 2, std::uint8_t{77}));
  EXPECT_EQ(readPngRgb(folder / "a.png")(1, 1), (Rgb8{77, 77, 77}));
}

TEST(Png, HeaderTellsSizeAndKind) {
  const TemporaryFolder folder;
  writePng(folder / "a.png", depthLike());
  const PngHeader header = readPngHeader(folder / "a.png");
  EXPECT_EQ(header.width, 19);
  EXPECT_EQ(header.height, 7);
  EXPECT_EQ(header.channels, 1);
  EXPECT_EQ(header.bits, 16);
}

TEST(Png, SameImageGivesSameBytesAndNoOtherFile) {
  const TemporaryFolder folder;
  writePng(folder / "a.png", colourful());
  writePng(folder / "b.png", colourful());
  EXPECT_EQ(readText(folder / "a.png"), readText(folder / "b.png"));
  EXPECT_EQ(folder.entryCount(), 2u);
}

TEST(Png, TruncatedFileIsRefusedWhereverItIsCut) {
  const TemporaryFolder folder;
  writePng(folder / "good.png", depthLike());
  const std::string good = readText(folder / "good.png");
  constexpr std::size_t kCheckSum = 4;  // of the end mark, which the decoder does not ask for
  for (std::size_t size = 0; size + kCheckSum < good.size(); ++size) {
    writeText(folder / "cut.png", good.substr(0, size));
    EXPECT_THROW(readPngGrey16(folder / "cut.png"), IoError) << size;
  }
}

TEST(Png, TruncatedFileSaysWhereItEnds) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "cut.png";
  writePng(path, depthLike());
  writeText(path, readText(path).substr(0, 60));
  EXPECT_EQ(
      messageOf<IoError>([&] { readPngGrey16(path); }),
      path.string() + ": byte 60: expected pixels of a 19x7 16-bit grey image, found the end of the file");
  writeText(path, readText(path).substr(0, 20));
  EXPECT_EQ(messageOf<IoError>([&] { readPngGrey16(path); }),
            path.string() + ": byte 20: expected a header, found the end of the file");
}

TEST(Png, OtherKindsOfFileAreNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.png";
  writePng(path, colourful());
  EXPECT_EQ(messageOf<IoError>([&] { readPngGrey16(path); }),
            path.string() + ": expected a 16-bit grey PNG, found 8-bit RGB");
  EXPECT_EQ(messageOf<IoError>([&] { readPngGrey8(path); }),
            path.string() + ": expected an 8-bit grey PNG, found 8-bit RGB");
  writeText(path, "this is no picture at all");
  EXPECT_EQ(messageOf<IoError>([&] { readPngRgb(path); }),
            path.string() + ": expected a PNG file, found another signature");
  writeText(path, "");
  EXPECT_EQ(messageOf<IoError>([&] { readPngRgb(path); }),
            path.string() + ": expected a PNG file, found an empty file");
  EXPECT_EQ(messageOf<IoError>([&] { readPngRgb(folder / "none.png"); }),
            (folder / "none.png").string() + ": expected a file to read, found none");
  EXPECT_EQ(messageOf<IoError>([&] { readPngRgb(folder.path()); }),
            folder.path().string() + ": expected a file to read, found a folder");
}

TEST(Png, DamagedPixelsAreRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.png";
  writePng(path, depthLike());
  std::string bytes = readText(path);
  bytes[bytes.size() - 25] = static_cast<char>(bytes[bytes.size() - 25] ^ 0x55);
  writeText(path, bytes);
  EXPECT_THROW(readPngGrey16(path), IoError);
}

TEST(Png, HugeHeadersTakeNoMemory) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.png";
  writeText(path, std::string("\211\120\116\107\015\012\032\012\000\000\000\015\111\110\104\122\000\001\206"
                              "\240\000\001\206\240\020\000\000\000\000\335\251\210\127",
                              33));
  EXPECT_EQ(messageOf<IoError>([&] { readPngGrey16(path); }),
            path.string() + ": expected an image of 1 to 268435456 pixels, found 100000x100000");
  writeText(path, std::string("\211\120\116\107\015\012\032\012\000\000\000\015\111\110\104\122\000\000\076"
                              "\200\000\000\076\200\020\000\000\000\000\064\205\134\101",
                              33));
  EXPECT_EQ(messageOf<IoError>([&] { readPngGrey16(path); }),
            path.string() +
                ": byte 33: expected pixels of a 16000x16000 16-bit grey image, found the end of the file");
}

TEST(Png, FolderThatIsMissingIsAnErrorOfWriting) {
  const TemporaryFolder folder;
  EXPECT_THROW(writePng(folder / "none/a.png", depthLike()), IoError);
  EXPECT_THROW(writePng(folder / "a.png", Image<std::uint16_t>()), InvalidArgument);
  EXPECT_EQ(folder.entryCount(), 0u);
}

}  // namespace
}  // namespace vdbfuse
