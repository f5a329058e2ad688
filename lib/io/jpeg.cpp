// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/jpeg.h"

#include <turbojpeg.h>

#include <memory>
#include <string>
#include <type_traits>

#include "io/file_bytes.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {

namespace {

using Decoder = std::unique_ptr<std::remove_pointer_t<tjhandle>, decltype(&tjDestroy)>;

std::pair<int, int> sizeOf(const std::filesystem::path& path, tjhandle decoder, const std::string& bytes) {
  if (bytes.empty()) throw IoError(path, "", "a JPEG file", "an empty file");
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  if (tjDecompressHeader3(decoder, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), &width,
                          &height, &subsampling, &colorspace) != 0)
    throw IoError(path, "", "a JPEG file", tjGetErrorStr2(decoder));
  checkImageSize(path, "", width, height);
  return {width, height};
}

}  // namespace

std::pair<int, int> readJpegSize(const std::filesystem::path& path) {
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  return sizeOf(path, decoder.get(), io::readFileBytes(path));
}

Image<Rgb8> readJpeg(const std::filesystem::path& path) {
  const std::string bytes = io::readFileBytes(path);
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  const Decoder decoder(tjInitDecompress(), tjDestroy);
  const auto [width, height] = sizeOf(path, decoder.get(), bytes);
  Image<Rgb8> image(width, height);
  const int failed = tjDecompress2(decoder.get(), data, bytes.size(), image.data()->data(), width, 0, height,
                                   TJPF_RGB, TJFLAG_ACCURATEDCT);
  if (failed == 0) return image;
  const std::string message = tjGetErrorStr2(decoder.get());
  // Warnings come back as failures too; all but a missing end leave a good picture.
  if (message.find("Premature end") != std::string::npos) {
    throw IoError(path, "byte " + std::to_string(bytes.size()),
                  "pixels of a " + sizeText(width, height) + " image", "the end of the file");
  }
  if (tjGetErrorCode(decoder.get()) == TJERR_FATAL) throw IoError(path, "", "a sound JPEG file", message);
  return image;
}

}  // namespace vdbfuse
