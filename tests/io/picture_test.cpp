// SPDX-License-Identifier: Apache-2.0
#include "io/picture.h"

#include <gtest/gtest.h>
#include <spng.h>
#include <tiffio.h>
#include <turbojpeg.h>

#include <array>
#include <string>
#include <vector>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/jpeg.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

// Two pixels beside each other, as bytes of the kind.
void writeRawPng(const fs::path& path, spng_color_type kind, int bits, std::vector<std::uint8_t> bytes,
                 const std::vector<spng_plte_entry>& palette = {},
                 const std::vector<std::uint8_t>& opacity = {}) {
  spng_ctx* context = spng_ctx_new(SPNG_CTX_ENCODER);
  spng_set_option(context, SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{2, 1, static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(kind), 0, 0, 0};
  spng_set_ihdr(context, &header);
  spng_plte plte{};
  plte.n_entries = static_cast<std::uint32_t>(palette.size());
  std::copy(palette.begin(), palette.end(), plte.entries);
  if (!palette.empty()) spng_set_plte(context, &plte);
  spng_trns trns{};
  trns.n_type3_entries = static_cast<std::uint32_t>(opacity.size());
  std::copy(opacity.begin(), opacity.end(), trns.type3_alpha);
  if (!opacity.empty()) spng_set_trns(context, &trns);
  ASSERT_EQ(spng_encode_image(context, bytes.data(), bytes.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE), 0);
  std::size_t size = 0;
  int code = 0;
  void* encoded = spng_get_png_buffer(context, &size, &code);
  writeText(path, std::string(static_cast<const char*>(encoded), size));
  free(encoded);
  spng_ctx_free(context);
}

struct TiffKind {
  int photometric = PHOTOMETRIC_RGB, samples = 3, bits = 8;
  bool is_tiled = false, has_alpha = false;
};

// Two pixels beside each other.
void writeTiff(const fs::path& path, const TiffKind& kind, std::vector<std::uint8_t> bytes) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 2);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind.samples);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind.photometric);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  const std::uint16_t extra[] = {EXTRASAMPLE_UNASSALPHA};
  if (kind.has_alpha) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, extra);
  if (kind.is_tiled) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
    bytes.resize(static_cast<std::size_t>(TIFFTileSize(tiff)));
    TIFFWriteTile(tiff, bytes.data(), 0, 0, 0, 0);
  } else {
    TIFFWriteScanline(tiff, bytes.data(), 0, 0);
  }
  TIFFClose(tiff);
}

// Of two bytes each, as the machine stores them.
std::vector<std::uint8_t> wide(const std::vector<std::uint16_t>& values) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
  return {bytes, bytes + 2 * values.size()};
}

void expectPixels(const io::Picture& picture, const Rgb8& first, const Rgb8& second) {
  ASSERT_EQ(picture.color.size(), 2u);
  EXPECT_EQ(picture.color(0, 0), first);
  EXPECT_EQ(picture.color(1, 0), second);
  EXPECT_EQ(picture.brightness(0, 0), brightnessOf(first));
  EXPECT_EQ(picture.brightness(1, 0), brightnessOf(second));
}

TEST(Pictures, BrightnessIsAWeightedSumOfTheColours) {
  EXPECT_EQ(brightnessOf({255, 255, 255}), 1.0F);
  EXPECT_EQ(brightnessOf({77, 77, 77}), static_cast<float>(77 / 255.0));
  EXPECT_FLOAT_EQ(brightnessOf({255, 0, 0}), 0.299F);
  EXPECT_FLOAT_EQ(brightnessOf({0, 255, 0}), 0.587F);
  EXPECT_FLOAT_EQ(brightnessOf({0, 0, 255}), 0.114F);
}

TEST(Pictures, GreyPngsHaveNoColourAndKeepSixteenBits) {
  const TemporaryFolder folder;
  Image<std::uint16_t> large(2, 1);
  large(0, 0) = 65535, large(1, 0) = 258;
  writePng(folder / "large.png", large);
  const io::Picture picture = io::readPictureFile(folder / "large.png");
  EXPECT_TRUE(picture.color.empty());
  EXPECT_TRUE(picture.opaque.empty());
  EXPECT_EQ(picture.brightness(0, 0), 1.0F);
  EXPECT_EQ(picture.brightness(1, 0), static_cast<float>(258 / 65535.0));
  // Two bits a pixel: 3 is white.
  writeRawPng(folder / "small.png", SPNG_COLOR_TYPE_GRAYSCALE, 2, {0b11010000});
  EXPECT_EQ(io::readPictureFile(folder / "small.png").brightness(0, 0), 1.0F);
  EXPECT_EQ(io::readPictureFile(folder / "small.png").brightness(1, 0), static_cast<float>(85 / 255.0));
}

TEST(Pictures, PngsOfColourAndOfPalettesHaveTheirColours) {
  const TemporaryFolder folder;
  Image<Rgb8> image(2, 1, Rgb8{1, 2, 3});
  image(1, 0) = {200, 100, 50};
  writePng(folder / "a.png", image);
  expectPixels(io::readPictureFile(folder / "a.png"), {1, 2, 3}, {200, 100, 50});
  writeRawPng(folder / "palette.png", SPNG_COLOR_TYPE_INDEXED, 8, {1, 0},
              {{200, 100, 50, 255}, {1, 2, 3, 255}});
  expectPixels(io::readPictureFile(folder / "palette.png"), {1, 2, 3}, {200, 100, 50});
  writeRawPng(folder / "deep.png", SPNG_COLOR_TYPE_TRUECOLOR, 16, wide({257, 514, 771, 65535, 0, 300}));
  const io::Picture deep = io::readPictureFile(folder / "deep.png");
  EXPECT_EQ(deep.color(0, 0), (Rgb8{1, 2, 3}));
  EXPECT_EQ(deep.color(1, 0), (Rgb8{255, 0, 1}));
  EXPECT_FLOAT_EQ(deep.brightness(1, 0), static_cast<float>((0.299 * 65535 + 0.114 * 300) / 65535));
}

TEST(Pictures, WhatIsNotOpaqueIsSaid) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.png";
  writeRawPng(path, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 8, {1, 2, 3, 255, 200, 100, 50, 255});
  EXPECT_TRUE(io::readPictureHeader(path).has_alpha);
  EXPECT_TRUE(io::readPictureFile(path).opaque.empty());
  writeRawPng(path, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, 8, {1, 2, 3, 127, 200, 100, 50, 128});
  const io::Picture picture = io::readPictureFile(path);
  expectPixels(picture, {1, 2, 3}, {200, 100, 50});
  EXPECT_EQ(picture.opaque(0, 0), 0);
  EXPECT_EQ(picture.opaque(1, 0), 255);
  writeRawPng(path, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, 16, wide({65535, 65535, 0, 0}));
  EXPECT_TRUE(io::readPictureFile(path).color.empty());
  EXPECT_EQ(io::readPictureFile(path).opaque(1, 0), 0);
  writeRawPng(path, SPNG_COLOR_TYPE_INDEXED, 8, {1, 0}, {{9, 9, 9, 255}, {1, 2, 3, 255}}, {0});
  EXPECT_EQ(io::readPictureFile(path).opaque(0, 0), 255);
  EXPECT_EQ(io::readPictureFile(path).opaque(1, 0), 0);
}

TEST(Pictures, JpegsAreGreyOrOfColour) {
  const TemporaryFolder folder;
  for (const int kind : {TJSAMP_GRAY, TJSAMP_444}) {
    const Image<Rgb8> image(24, 16, kind == TJSAMP_GRAY ? Rgb8{90, 90, 90} : Rgb8{200, 100, 30});
    tjhandle encoder = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    tjCompress2(encoder, image.data()->data(), 24, 0, 16, TJPF_RGB, &bytes, &size, kind, 100, 0);
    writeText(folder / "a.jpg", std::string(reinterpret_cast<const char*>(bytes), size));
    tjFree(bytes);
    tjDestroy(encoder);
    const io::Picture picture = io::readPictureFile(folder / "a.jpg");
    EXPECT_EQ(picture.color.empty(), kind == TJSAMP_GRAY);
    EXPECT_NEAR(picture.brightness(20, 12), brightnessOf(image(0, 0)), 0.01);
    EXPECT_EQ(io::readPictureHeader(folder / "a.jpg").width, 24);
  }
  // A long comment before the header, as large thumbnails are.
  const std::string plain = readText(folder / "a.jpg");
  std::string comments;
  for (int i = 0; i < 2; ++i) comments += "\xff\xfe\xff\xff" + std::string(65533, 'x');
  writeText(folder / "a.jpg", plain.substr(0, 2) + comments + plain.substr(2));
  EXPECT_EQ(readJpegSize(folder / "a.jpg"), std::make_pair(24, 16));
}

TEST(Pictures, TiffsOfAllKindsAreRead) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.tif";
  writeTiff(path, {PHOTOMETRIC_RGB, 3, 8}, {1, 2, 3, 200, 100, 50});
  expectPixels(io::readPictureFile(path), {1, 2, 3}, {200, 100, 50});
  writeTiff(path, {PHOTOMETRIC_RGB, 3, 8, true}, {1, 2, 3, 200, 100, 50});
  expectPixels(io::readPictureFile(path), {1, 2, 3}, {200, 100, 50});
  writeTiff(path, {PHOTOMETRIC_MINISBLACK, 1, 8}, {255, 51});
  EXPECT_TRUE(io::readPictureFile(path).color.empty());
  EXPECT_EQ(io::readPictureFile(path).brightness(1, 0), 0.2F);
  writeTiff(path, {PHOTOMETRIC_MINISBLACK, 1, 16}, wide({13107, 300}));
  EXPECT_EQ(io::readPictureFile(path).brightness(0, 0), 0.2F);
  EXPECT_EQ(io::readPictureFile(path).brightness(1, 0), static_cast<float>(300 / 65535.0));
  writeTiff(path, {PHOTOMETRIC_MINISWHITE, 1, 16}, wide({0, 65535}));
  EXPECT_EQ(io::readPictureFile(path).brightness(0, 0), 1.0F);
  writeTiff(path, {PHOTOMETRIC_RGB, 4, 16, false, true},
            wide({257, 514, 771, 65535, 51400, 25700, 12850, 0}));
  const io::Picture deep = io::readPictureFile(path);
  expectPixels(deep, {1, 2, 3}, {200, 100, 50});
  EXPECT_EQ(deep.opaque(1, 0), 0);
}

TEST(Pictures, OfOtherKindsAreNamed) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.tif";
  writeTiff(path, {PHOTOMETRIC_RGB, 3, 16, true}, wide({1, 2, 3, 200, 100, 50}));
  EXPECT_EQ(messageOf<IoError>([&] { io::readPictureHeader(path); }),
            path.string() +
                ": expected a picture of 8 bits, or of 16 as grey or RGB in strips, found 3 "
                "channels of 16 bits in tiles");
  writeTiff(path, {PHOTOMETRIC_MINISBLACK, 1, 32}, wide({1, 2, 3, 4}));
  EXPECT_EQ(messageOf<IoError>([&] { io::readPictureFile(path); }),
            path.string() +
                ": expected a picture of 8 bits, or of 16 as grey or RGB in strips, found 1 "
                "channels of 32 bits");
  writeText(path, "GIF89a");
  EXPECT_FALSE(io::isPictureFile(path));
  EXPECT_EQ(messageOf<IoError>([&] { io::readPictureFile(path); }),
            path.string() + ": expected a PNG, JPEG or TIFF file, found something else");
}

TEST(Pictures, TiffsThatAreCutAreRefused) {
  const TemporaryFolder folder;
  const fs::path path = folder / "a.tif";
  writeTiff(path, {PHOTOMETRIC_RGB, 3, 8}, {1, 2, 3, 200, 100, 50});
  const std::string good = readText(path);
  for (std::size_t size = 4; size + 1 < good.size(); ++size) {
    writeText(path, good.substr(0, size));
    EXPECT_THROW(io::readPictureFile(path), IoError) << size;
  }
}

}  // namespace
}  // namespace vdbfuse
