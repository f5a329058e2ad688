// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/image_size.h"
#include "io/rgba_picture.h"
#include "io/tiff_file.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;

bool isGrey(const TiffTags& tags) {
  return tags.photometric == PHOTOMETRIC_MINISBLACK || tags.photometric == PHOTOMETRIC_MINISWHITE;
}

void checkKind(const fs::path& path, const TiffTags& tags) {
  const bool is_whole = tags.number == SAMPLEFORMAT_UINT && tags.bits <= 16;
  const bool is_plain = !tags.is_tiled && !tags.is_planar &&
                        (tags.photometric == PHOTOMETRIC_RGB ? tags.samples >= 3 : isGrey(tags));
  if (is_whole && (tags.bits <= 8 || (tags.bits == 16 && is_plain))) return;
  throw IoError(path, "", "a picture of 8 bits, or of 16 as grey or RGB in strips",
                std::to_string(tags.samples) + " channels of " + std::to_string(tags.bits) + " bits" +
                    (tags.is_tiled    ? " in tiles"
                     : tags.is_planar ? " in planes"
                                      : ""));
}

// No compression of TIFF makes more than about 3000 bytes of one: a short file need not cost us memory.
void checkLength(const fs::path& path, const TiffTags& tags) {
  constexpr std::uint64_t kMostPerByte = 3000;
  const std::uint64_t size = fileSize(path);
  const auto pixels = static_cast<std::uint64_t>(tags.width) * static_cast<std::uint64_t>(tags.height);
  const std::uint64_t stored = pixels * static_cast<std::uint64_t>(tags.bits) / 8;
  if (stored / kMostPerByte <= size) return;
  throw IoError(path, "byte " + std::to_string(size),
                "pixels of a " + sizeText(tags.width, tags.height) + " image", "the end of the file");
}

Image<Rgba<std::uint8_t>> readSmall(const TiffFile& file) {
  const TiffTags& tags = file.tags();
  std::vector<std::uint32_t> packed(static_cast<std::size_t>(tags.width) *
                                    static_cast<std::size_t>(tags.height));
  if (TIFFReadRGBAImageOriented(file.get(), static_cast<std::uint32_t>(tags.width),
                                static_cast<std::uint32_t>(tags.height), packed.data(), ORIENTATION_TOPLEFT,
                                1) != 1)
    file.fail();
  Image<Rgba<std::uint8_t>> image(tags.width, tags.height);
  for (std::size_t i = 0; i < packed.size(); ++i) {
    const auto part = [&](int k) { return static_cast<std::uint8_t>(packed[i] >> (8 * k)); };
    image.data()[i] = {part(0), part(1), part(2), part(3)};
  }
  return image;
}

Image<Rgba<std::uint16_t>> readLarge(const TiffFile& file) {
  constexpr std::uint16_t kLargest = 65535;
  const TiffTags& tags = file.tags();
  const auto width = static_cast<std::size_t>(tags.width), samples = static_cast<std::size_t>(tags.samples);
  if (file.bytesOfRow() != 2 * width * samples) file.fail();
  const std::size_t colors = isGrey(tags) ? 1 : 3;
  const bool is_inverted = tags.photometric == PHOTOMETRIC_MINISWHITE;
  std::vector<std::uint16_t> row(width * samples);
  Image<Rgba<std::uint16_t>> image(tags.width, tags.height);
  for (int y = 0; y < tags.height; ++y) {
    file.readRow(y, reinterpret_cast<unsigned char*>(row.data()));
    for (std::size_t x = 0; x < width; ++x) {
      Rgba<std::uint16_t>& pixel = image.row(y)[x];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint16_t value = row[x * samples + (colors == 1 ? 0 : k)];
        pixel[k] = is_inverted ? static_cast<std::uint16_t>(kLargest - value) : value;
      }
      pixel[3] = tags.has_alpha && samples > colors ? row[x * samples + colors] : kLargest;
    }
  }
  return image;
}

}  // namespace

PictureHeader readTiffPictureHeader(const fs::path& path) {
  const TiffFile file(path);
  checkKind(path, file.tags());
  return {file.tags().width, file.tags().height, file.tags().has_alpha};
}

RgbaPicture readTiffRgba(const fs::path& path) {
  const TiffFile file(path);
  checkKind(path, file.tags());
  checkLength(path, file.tags());
  RgbaPicture picture;
  picture.is_grey = isGrey(file.tags());
  if (file.tags().bits == 16) {
    picture.pixels = readLarge(file);
  } else {
    picture.pixels = readSmall(file);
  }
  return picture;
}

}  // namespace vdbfuse::io
