// SPDX-License-Identifier: Apache-2.0
#include "io/tiff_file.h"

#include <array>
#include <cstdarg>
#include <cstdio>

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

TiffTags readTags(const fs::path& path, TIFF* tiff) {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1, number = SAMPLEFORMAT_UINT, planar = PLANARCONFIG_CONTIG, extra = 0;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  std::uint16_t* kinds = nullptr;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &number);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planar);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &extra, &kinds);
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  checkImageSize(path, "", width, height);
  const bool has_alpha = extra > 0 && kinds[0] != EXTRASAMPLE_UNSPECIFIED;
  return {static_cast<int>(width), static_cast<int>(height),      bits,     samples, number, photometric,
          TIFFIsTiled(tiff) != 0,  planar != PLANARCONFIG_CONTIG, has_alpha};
}

}  // namespace

TiffFile::TiffFile(const fs::path& path) : path_(path), tiff_(nullptr, TIFFClose) {
  fileSize(path);
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keepError, &error_);
  TIFFOpenOptionsSetWarningHandlerExtR(
      options.get(), [](auto...) { return 1; }, nullptr);
  tiff_.reset(TIFFOpenExt(path.c_str(), "r", options.get()));
  if (!tiff_) fail();
  tags_ = readTags(path, tiff_.get());
}

void TiffFile::readRow(int y, unsigned char* row) const {
  if (TIFFReadScanline(tiff_.get(), row, static_cast<std::uint32_t>(y)) != 1) fail();
}

void TiffFile::fail() const {
  throw IoError(path_, "", "a sound TIFF file", error_.empty() ? "a damaged one" : error_);
}

}  // namespace vdbfuse::io
