// SPDX-License-Identifier: Apache-2.0
#include "io/tiff.h"

#include <cstring>
#include <string>
#include <vector>

#include "io/tiff_file.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;

RasterHeader headerOf(const fs::path& path, const TiffTags& tags) {
  RasterHeader header{RasterKind::Tiff, tags.width, tags.height, tags.bits, RasterHeader::Number::Unsigned};
  if (tags.number == SAMPLEFORMAT_INT) header.number = RasterHeader::Number::Signed;
  if (tags.number == SAMPLEFORMAT_IEEEFP) header.number = RasterHeader::Number::Float;
  const int bits = tags.bits;
  const bool fits = header.isFloat() ? bits == 32 || bits == 64 : bits == 8 || bits == 16 || bits == 32;
  if (tags.samples != 1 || !fits || tags.is_tiled)
    throw IoError(path, "", "one whole number or float a pixel, in strips",
                  std::to_string(tags.samples) + " of " + std::to_string(bits) + " bits" +
                      (tags.is_tiled ? " in tiles" : ""));
  return header;
}

template <class T>
float at(const unsigned char* row, int x) {
  T value;
  std::memcpy(&value, row + sizeof(T) * static_cast<std::size_t>(x), sizeof(T));
  return static_cast<float>(value);
}

float numberAt(const RasterHeader& header, const unsigned char* row, int x) {
  if (header.isFloat()) return header.bits == 32 ? at<float>(row, x) : at<double>(row, x);
  const bool is_signed = header.number == RasterHeader::Number::Signed;
  if (header.bits == 8) return is_signed ? at<std::int8_t>(row, x) : at<std::uint8_t>(row, x);
  if (header.bits == 16) return is_signed ? at<std::int16_t>(row, x) : at<std::uint16_t>(row, x);
  return is_signed ? at<std::int32_t>(row, x) : at<std::uint32_t>(row, x);
}

}  // namespace

RasterHeader readTiffHeader(const fs::path& path) { return headerOf(path, TiffFile(path).tags()); }

Image<float> readTiff(const fs::path& path) {
  const TiffFile file(path);
  const RasterHeader header = headerOf(path, file.tags());
  const std::size_t row_bytes = file.bytesOfRow();
  const std::size_t wanted =
      static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.bits) / 8;
  if (row_bytes < wanted || row_bytes > 2 * wanted + 64) file.fail();
  std::vector<unsigned char> row(row_bytes);
  Image<float> image(header.width, header.height);
  for (int y = 0; y < header.height; ++y) {
    file.readRow(y, row.data());
    for (int x = 0; x < header.width; ++x) image(x, y) = numberAt(header, row.data(), x);
  }
  return image;
}

}  // namespace vdbfuse::io
