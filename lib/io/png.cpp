// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/png.h"

#include <spng.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>

#include "io/encoded_picture.h"
#include "io/file_bytes.h"
#include "io/image_size.h"
#include "io/rgba_picture.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Context = std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)>;

// Signature, then the header chunk.
constexpr std::size_t kHeaderBytes = 33;

PngHeader headerOf(const spng_ihdr& ihdr) {
  PngHeader header{static_cast<int>(ihdr.width), static_cast<int>(ihdr.height), 1, ihdr.bit_depth};
  if (ihdr.color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA) header.channels = 2;
  if (ihdr.color_type == SPNG_COLOR_TYPE_TRUECOLOR) header.channels = 3;
  if (ihdr.color_type == SPNG_COLOR_TYPE_TRUECOLOR_ALPHA) header.channels = 4;
  return header;
}

std::string kindText(const spng_ihdr& ihdr) {
  static constexpr const char* kNames[] = {"grey",           "", "RGB",          "palette",
                                           "grey and alpha", "", "RGB and alpha"};
  return std::to_string(ihdr.bit_depth) + "-bit " + kNames[ihdr.color_type];
}

// A PNG file in memory and the decoder that reads it.
class Decoder {
 public:
  Decoder(const std::filesystem::path& path, std::size_t limit)
      : storage_(io::readFileStart(path, limit)),
        picture_{path, "", storage_, 0, 0},
        context_(spng_ctx_new(0), spng_ctx_free) {
    begin();
  }
  // The picture's bytes must outlive the decoder.
  explicit Decoder(const io::EncodedPicture& picture)
      : picture_(picture), context_(spng_ctx_new(0), spng_ctx_free) {
    begin();
  }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  const spng_ihdr& ihdr() const { return ihdr_; }

  void decode(void* pixels, std::size_t size, int format, int flags) {
    check(spng_decode_image(context_.get(), pixels, size, format, flags));
    check(spng_decode_chunks(context_.get()));  // up to the end mark: a file cut behind its pixels is cut too
  }

  // Deflate cannot make more than 1032 bytes of one: a file this short need not cost us memory.
  void checkLength(std::size_t decoded) const {
    if (decoded / 1100 > picture_.bytes.size()) truncated();
  }

 private:
  void begin() {
    checkSignature();
    spng_set_png_buffer(context_.get(), picture_.bytes.data(), picture_.bytes.size());
    check(spng_get_ihdr(context_.get(), &ihdr_));
    io::checkPictureSize(picture_, ihdr_.width, ihdr_.height);
  }

  void checkSignature() const {
    static constexpr std::array<char, 8> kSignature = {'\x89', 'P', 'N', 'G', '\r', '\n', '\x1a', '\n'};
    const std::string_view bytes = picture_.bytes;
    if (bytes.empty()) throw IoError(picture_.path, picture_.place, "a PNG file", "an empty file");
    const auto compared = static_cast<std::ptrdiff_t>(std::min(bytes.size(), kSignature.size()));
    if (!std::equal(bytes.begin(), bytes.begin() + compared, kSignature.begin()))
      throw IoError(picture_.path, picture_.place, "a PNG file", "another signature");
  }

  void check(int code) const {
    if (code == SPNG_OK) return;
    if (code == SPNG_IO_EOF) truncated();
    throw IoError(picture_.path, picture_.place, "a sound PNG file", spng_strerror(code));
  }

  [[noreturn]] void truncated() const {
    const std::string promised = ihdr_.width == 0 ? "a header"
                                                  : "pixels of a " + sizeText(ihdr_.width, ihdr_.height) +
                                                        " " + kindText(ihdr_) + " image";
    throw IoError(picture_.path, io::endPlace(picture_), promised, "the end of the file");
  }

  std::string storage_;  // of a file's own bytes
  io::EncodedPicture picture_;
  Context context_;
  spng_ihdr ihdr_{};
};

template <class T>
Image<T> decodeImage(Decoder& decoder, int format, int flags = 0) {
  const spng_ihdr& ihdr = decoder.ihdr();
  const std::size_t size = sizeof(T) * ihdr.width * ihdr.height;
  decoder.checkLength(std::size_t{ihdr.width} * ihdr.height * headerOf(ihdr).channels * ihdr.bit_depth / 8);
  Image<T> image(static_cast<int>(ihdr.width), static_cast<int>(ihdr.height));
  decoder.decode(image.data(), size, format, flags);
  return image;
}

template <class T>
void encode(const std::filesystem::path& path, const Image<T>& image, std::uint8_t bits,
            std::uint8_t color_type) {
  if (image.empty()) throw InvalidArgument("image", "an empty image cannot be written as PNG");
  const Context context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr ihdr{};
  ihdr.width = static_cast<std::uint32_t>(image.width());
  ihdr.height = static_cast<std::uint32_t>(image.height());
  ihdr.bit_depth = bits;
  ihdr.color_type = color_type;
  int code = spng_set_ihdr(context.get(), &ihdr);
  if (code == SPNG_OK) {
    code = spng_encode_image(context.get(), image.data(), image.size() * sizeof(T), SPNG_FMT_PNG,
                             SPNG_ENCODE_FINALIZE);
  }
  std::size_t size = 0;
  const std::unique_ptr<void, decltype(&std::free)> bytes(
      code == SPNG_OK ? spng_get_png_buffer(context.get(), &size, &code) : nullptr, std::free);
  if (!bytes) throw IoError(path, std::string("cannot be encoded: ") + spng_strerror(code));
  io::writeFileBytes(path, {static_cast<const char*>(bytes.get()), size});
}

}  // namespace

PngHeader readPngHeader(const std::filesystem::path& path) {
  return headerOf(Decoder(path, kHeaderBytes).ihdr());
}

Image<Rgb8> readPngRgb(const std::filesystem::path& path) {
  Decoder decoder(path, SIZE_MAX);
  return decodeImage<Rgb8>(decoder, SPNG_FMT_RGB8);
}

Image<Rgb8> io::decodePng(const EncodedPicture& picture) {
  Decoder decoder(picture);
  return decodeImage<Rgb8>(decoder, SPNG_FMT_RGB8);
}

io::RgbaPicture io::readPngRgba(const std::filesystem::path& path) {
  Decoder decoder(path, SIZE_MAX);
  RgbaPicture picture;
  picture.is_grey = decoder.ihdr().color_type == SPNG_COLOR_TYPE_GRAYSCALE ||
                    decoder.ihdr().color_type == SPNG_COLOR_TYPE_GRAYSCALE_ALPHA;
  if (decoder.ihdr().bit_depth == 16) {
    picture.pixels = decodeImage<Rgba<std::uint16_t>>(decoder, SPNG_FMT_RGBA16, SPNG_DECODE_TRNS);
  } else {
    picture.pixels = decodeImage<Rgba<std::uint8_t>>(decoder, SPNG_FMT_RGBA8, SPNG_DECODE_TRNS);
  }
  return picture;
}

Image<std::uint8_t> readPngGrey8(const std::filesystem::path& path) {
  Decoder decoder(path, SIZE_MAX);
  const spng_ihdr& ihdr = decoder.ihdr();
  if (ihdr.color_type != SPNG_COLOR_TYPE_GRAYSCALE || ihdr.bit_depth > 8)
    throw IoError(path, "", "an 8-bit grey PNG", kindText(ihdr));
  return decodeImage<std::uint8_t>(decoder, SPNG_FMT_G8);
}

Image<std::uint16_t> readPngGrey16(const std::filesystem::path& path) {
  Decoder decoder(path, SIZE_MAX);
  const spng_ihdr& ihdr = decoder.ihdr();
  if (ihdr.color_type != SPNG_COLOR_TYPE_GRAYSCALE || ihdr.bit_depth != 16)
    throw IoError(path, "", "a 16-bit grey PNG", kindText(ihdr));
  return decodeImage<std::uint16_t>(decoder, SPNG_FMT_PNG);
}

void writePng(const std::filesystem::path& path, const Image<Rgb8>& image) {
  encode(path, image, 8, SPNG_COLOR_TYPE_TRUECOLOR);
}

void writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image) {
  encode(path, image, 8, SPNG_COLOR_TYPE_GRAYSCALE);
}

void writePng(const std::filesystem::path& path, const Image<std::uint16_t>& image) {
  encode(path, image, 16, SPNG_COLOR_TYPE_GRAYSCALE);
}

}  // namespace vdbfuse
