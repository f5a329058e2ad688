// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/jpeg.h"

#include <turbojpeg.h>

#include <memory>
#include <optional>
#include <string>
#include <type_traits>

#include "io/encoded_picture.h"
#include "io/file_bytes.h"
#include "io/image_size.h"
#include "io/rgba_picture.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {

namespace {

using Decoder = std::unique_ptr<std::remove_pointer_t<tjhandle>, decltype(&tjDestroy)>;

struct Header {
  int width = 0, height = 0;
  bool is_grey = false;
};

// Nothing where the bytes are no header.
std::optional<Header> findHeader(tjhandle decoder, std::string_view bytes) {
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  if (tjDecompressHeader3(decoder, data, bytes.size(), &width, &height, &subsampling, &colorspace) != 0)
    return std::nullopt;
  return Header{width, height, colorspace == TJCS_GRAY};
}

Header headerOf(const std::filesystem::path& path, const std::string& place, tjhandle decoder,
                std::string_view bytes) {
  if (bytes.empty()) throw IoError(path, place, "a JPEG file", "an empty file");
  const std::optional<Header> header = findHeader(decoder, bytes);
  if (!header) throw IoError(path, place, "a JPEG file", tjGetErrorStr2(decoder));
  checkImageSize(path, place, header->width, header->height);
  return *header;
}

// A byte holds a few hundred pixels at best: a file this short need not cost us memory.
void checkLength(const io::EncodedPicture& picture, const Header& header) {
  constexpr std::int64_t kMostPixelsPerByte = 2000;
  const std::int64_t pixels = std::int64_t{header.width} * header.height;
  if (pixels / kMostPixelsPerByte > static_cast<std::int64_t>(picture.bytes.size()))
    throw IoError(picture.path, endPlace(picture),
                  "pixels of a " + sizeText(header.width, header.height) + " image", "the end of the file");
}

template <class Pixel>
Image<Pixel> decode(const io::EncodedPicture& picture, const Header& header, tjhandle decoder, int format) {
  Image<Pixel> image(header.width, header.height);
  const auto* data = reinterpret_cast<const unsigned char*>(picture.bytes.data());
  const int failed = tjDecompress2(decoder, data, picture.bytes.size(), image.data()->data(), header.width, 0,
                                   header.height, format, TJFLAG_ACCURATEDCT);
  if (failed == 0) return image;
  const std::string message = tjGetErrorStr2(decoder);
  // Warnings come back as failures too; all but a missing end leave a good picture.
  if (message.find("Premature end") != std::string::npos)
    throw IoError(picture.path, endPlace(picture),
                  "pixels of a " + sizeText(header.width, header.height) + " image", "the end of the file");
  if (tjGetErrorCode(decoder) == TJERR_FATAL)
    throw IoError(picture.path, picture.place, "a sound JPEG file", message);
  return image;
}

}  // namespace

std::pair<int, int> readJpegSize(const std::filesystem::path& path) {
  // The header nearly always lies near the beginning; behind a large thumbnail, further in.
  constexpr std::size_t kUsualBytes = 1 << 16;
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  std::string bytes = io::readFileStart(path, kUsualBytes);
  const std::optional<Header> found = findHeader(decoder.get(), bytes);
  if (bytes.size() == kUsualBytes && !(found && found->width > 0)) bytes = io::readFileBytes(path);
  const Header header = headerOf(path, "", decoder.get(), bytes);
  return {header.width, header.height};
}

Image<Rgb8> readJpeg(const std::filesystem::path& path) {
  const std::string bytes = io::readFileBytes(path);
  return io::decodeJpeg({path, "", bytes, 0, 0});
}

Image<Rgb8> io::decodeJpeg(const EncodedPicture& picture) {
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  const Header header = headerOf(picture.path, picture.place, decoder.get(), picture.bytes);
  checkPictureSize(picture, header.width, header.height);
  checkLength(picture, header);
  return decode<Rgb8>(picture, header, decoder.get(), TJPF_RGB);
}

io::RgbaPicture io::readJpegRgba(const std::filesystem::path& path) {
  const std::string bytes = io::readFileBytes(path);
  const EncodedPicture picture{path, "", bytes, 0, 0};
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  const Header header = headerOf(path, "", decoder.get(), bytes);
  checkLength(picture, header);
  return {decode<Rgba<std::uint8_t>>(picture, header, decoder.get(), TJPF_RGBA), header.is_grey};
}

}  // namespace vdbfuse
