// SPDX-License-Identifier: Apache-2.0
#include "io/tiff.h"

#include <tiffio.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;

// Keeps the library's first complaint in place of printing it.
int keepError(TIFF*, void* user, const char* /*module*/, const char* format, va_list arguments) {
  auto& message = *static_cast<std::string*>(user);
  if (!message.empty()) return 1;
  std::array<char, 256> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  message = text.data();
  for (char& c : message) c = c == '\n' ? ' ' : c;
  return 1;
}

class TiffFile {
 public:
  explicit TiffFile(const fs::path& path) : path_(path), tiff_(nullptr, TIFFClose) {
    fileSize(path);
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepError, &error_);
    TIFFOpenOptionsSetWarningHandlerExtR(
        options.get(), [](auto...) { return 1; }, nullptr);
    tiff_.reset(TIFFOpenExt(path.c_str(), "r", options.get()));
    if (!tiff_) fail();
    readHeader();
  }

  const RasterHeader& header() const { return header_; }

  Image<float> read() {
    const tmsize_t row_bytes = TIFFScanlineSize(tiff_.get());
    const auto wanted = static_cast<tmsize_t>(header_.width) * header_.bits / 8;
    if (row_bytes < wanted || row_bytes > 2 * wanted + 64) fail();
    std::vector<unsigned char> row(static_cast<std::size_t>(row_bytes));
    Image<float> image(header_.width, header_.height);
    for (int y = 0; y < header_.height; ++y) {
      if (TIFFReadScanline(tiff_.get(), row.data(), static_cast<std::uint32_t>(y)) != 1) fail();
      for (int x = 0; x < header_.width; ++x) image(x, y) = number(row.data(), x);
    }
    return image;
  }

 private:
  void readHeader() {
    std::uint32_t width = 0, height = 0;
    std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT;
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &height);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLESPERPIXEL, &samples);
    TIFFGetFieldDefaulted(tiff_.get(), TIFFTAG_SAMPLEFORMAT, &format);
    checkImageSize(path_, "", width, height);
    header_ = {RasterKind::Tiff, static_cast<int>(width), static_cast<int>(height), bits,
               RasterHeader::Number::Unsigned};
    if (format == SAMPLEFORMAT_INT) header_.number = RasterHeader::Number::Signed;
    if (format == SAMPLEFORMAT_IEEEFP) header_.number = RasterHeader::Number::Float;
    const bool fits = header_.isFloat() ? bits == 32 || bits == 64 : bits == 8 || bits == 16 || bits == 32;
    if (samples != 1 || !fits || TIFFIsTiled(tiff_.get()))
      throw IoError(path_, "", "one whole number or float a pixel, in strips",
                    std::to_string(samples) + " of " + std::to_string(bits) + " bits" +
                        (TIFFIsTiled(tiff_.get()) ? " in tiles" : ""));
  }

  template <class T>
  static float at(const unsigned char* row, int x) {
    T value;
    std::memcpy(&value, row + sizeof(T) * static_cast<std::size_t>(x), sizeof(T));
    return static_cast<float>(value);
  }

  float number(const unsigned char* row, int x) const {
    if (header_.isFloat()) return header_.bits == 32 ? at<float>(row, x) : at<double>(row, x);
    const bool is_signed = header_.number == RasterHeader::Number::Signed;
    if (header_.bits == 8) return is_signed ? at<std::int8_t>(row, x) : at<std::uint8_t>(row, x);
    if (header_.bits == 16) return is_signed ? at<std::int16_t>(row, x) : at<std::uint16_t>(row, x);
    return is_signed ? at<std::int32_t>(row, x) : at<std::uint32_t>(row, x);
  }

  [[noreturn]] void fail() const {
    throw IoError(path_, "", "a sound TIFF file", error_.empty() ? "a damaged one" : error_);
  }

  const fs::path& path_;
  std::string error_;
  std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff_;
  RasterHeader header_;
};

}  // namespace

RasterHeader readTiffHeader(const fs::path& path) { return TiffFile(path).header(); }

Image<float> readTiff(const fs::path& path) { return TiffFile(path).read(); }

}  // namespace vdbfuse::io
