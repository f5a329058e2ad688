// SPDX-License-Identifier: Apache-2.0
#include "formats/sens_file.h"

#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "io/encoded_picture.h"
#include "io/file_bytes.h"
#include "io/image_size.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMatrixBytes = 64, kFrameHeader = kMatrixBytes + 32;
constexpr std::uint64_t kLongestName = 4096;

std::string byteText(std::uint64_t byte) { return "byte " + std::to_string(byte); }

std::uint64_t littleEndian(const char* bytes, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

// Reads numbers one after the other.
class Reader {
 public:
  explicit Reader(const fs::path& path)
      : path_(path), size_(io::fileSize(path)), file_(path, std::ios::binary) {
    if (!file_) throw IoError(path, "cannot be opened");
  }

  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return size_ - position_; }

  std::uint64_t unsignedNumber(std::size_t bytes, const std::string& what) {
    char buffer[8];
    take(buffer, bytes, what);
    return littleEndian(buffer, bytes);
  }
  double single(const std::string& what) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(unsignedNumber(4, what)));
  }
  Eigen::Matrix4d matrix(const std::string& what) {
    char buffer[kMatrixBytes];
    take(buffer, kMatrixBytes, what);
    Eigen::Matrix4d result;
    for (int i = 0; i < 16; ++i) {
      const auto word = static_cast<std::uint32_t>(littleEndian(buffer + 4 * i, 4));
      result(i / 4, i % 4) = std::bit_cast<float>(word);
    }
    return result;
  }
  void skip(std::uint64_t bytes, const std::string& what) {
    require(bytes, what);
    position_ += bytes;
    file_.seekg(static_cast<std::streamoff>(position_));
  }
  void require(std::uint64_t bytes, const std::string& what) const {
    if (bytes > left())
      throw IoError(path_, byteText(position_), what + " of " + std::to_string(bytes) + " bytes",
                    "the end of the file");
  }

 private:
  void take(char* bytes, std::size_t count, const std::string& what) {
    require(count, what);
    if (!file_.read(bytes, static_cast<std::streamsize>(count))) throw IoError(path_, "cannot be read");
    position_ += count;
  }

  const fs::path& path_;
  std::uint64_t size_, position_ = 0;
  std::ifstream file_;
};

SensCamera readCamera(Reader& reader, const std::string& name) {
  SensCamera camera;
  camera.intrinsics_byte = reader.position();
  camera.intrinsics = reader.matrix("intrinsics of " + name);
  camera.extrinsics = reader.matrix("extrinsics of " + name);
  return camera;
}

SensDepth depthCompression(const fs::path& path, Reader& reader) {
  const std::string place = byteText(reader.position());
  const auto kind = static_cast<std::int32_t>(reader.unsignedNumber(4, "the depth compression"));
  if (kind == 0) return SensDepth::Raw;
  if (kind == 1) return SensDepth::Zlib;
  throw IoError(path, place, "depth that is raw (0) or zlib (1)",
                kind == 2 ? "occi (2)" : std::to_string(kind));
}

SensColor colorCompression(Reader& reader) {
  const auto kind = static_cast<std::int32_t>(reader.unsignedNumber(4, "the colour compression"));
  return kind >= 0 && kind <= 2 ? static_cast<SensColor>(kind) : SensColor::Other;
}

void readSize(const fs::path& path, Reader& reader, SensCamera& camera, bool may_be_empty) {
  const std::string place = byteText(reader.position());
  const std::uint64_t width = reader.unsignedNumber(4, "a width"),
                      height = reader.unsignedNumber(4, "a height");
  if (may_be_empty && (width == 0 || height == 0)) return;
  checkImageSize(path, place, static_cast<std::int64_t>(width), static_cast<std::int64_t>(height));
  camera.width = static_cast<int>(width), camera.height = static_cast<int>(height);
}

void readShift(const fs::path& path, Reader& reader, SensFile& file) {
  const std::string place = byteText(reader.position());
  file.depth_shift = reader.single("the depth shift");
  if (!(file.depth_shift > 0 && std::isfinite(file.depth_shift)))
    throw IoError(path, place, "a depth shift above 0", numberText(file.depth_shift));
}

SensFrame readFrame(Reader& reader) {
  SensFrame frame;
  frame.begin = reader.position();
  frame.world_from_camera = reader.matrix("a pose");
  reader.skip(16, "the times of a frame");
  frame.color_bytes = reader.unsignedNumber(8, "the size of a picture");
  frame.depth_bytes = reader.unsignedNumber(8, "the size of a depth map");
  frame.color_begin = reader.position();
  reader.skip(frame.color_bytes, "a picture");
  frame.depth_begin = reader.position();
  reader.skip(frame.depth_bytes, "a depth map");
  return frame;
}

void readFrames(const fs::path& path, Reader& reader, SensFile& file) {
  const std::string place = byteText(reader.position());
  const std::uint64_t count = reader.unsignedNumber(8, "the number of frames");
  if (count > reader.left() / kFrameHeader)
    throw IoError(path, place, "no more frames than the file has room for", std::to_string(count));
  for (std::uint64_t i = 0; i < count; ++i) file.frames.push_back(readFrame(reader));
}

// Exactly `size` bytes, or an IoError.
std::string inflated(const SensFile& file, const SensFrame& frame, const std::string& packed,
                     std::size_t size) {
  constexpr std::size_t kBestRatio = 1100;  // of deflate
  const std::string expected = std::to_string(size) + " bytes of depth packed by zlib";
  if (size / kBestRatio > packed.size())
    throw IoError(file.path, byteText(frame.depth_begin), expected,
                  std::to_string(packed.size()) + " packed bytes");
  std::string bytes(size, '\0');
  uLongf length = size;
  const int code = uncompress(reinterpret_cast<Bytef*>(bytes.data()), &length,
                              reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (code == Z_MEM_ERROR) throw IoError(file.path, "no memory to unpack a depth map");
  if (code == Z_BUF_ERROR || (code == Z_OK && length != size))
    throw IoError(file.path, byteText(frame.depth_begin), expected, "another number of them");
  if (code != Z_OK) throw IoError(file.path, byteText(frame.depth_begin), expected, "damaged data");
  return bytes;
}

}  // namespace

SensFile indexSens(const fs::path& path) {
  Reader reader(path);
  SensFile file;
  file.path = path;
  const std::uint64_t version = reader.unsignedNumber(4, "a version");
  if (version != 4) throw IoError(path, "byte 0", "version 4 of .sens", std::to_string(version));
  const std::uint64_t name = reader.unsignedNumber(8, "the length of a name");
  if (name > kLongestName)
    throw IoError(path, "byte 4", "a name of at most 4096 bytes", std::to_string(name));
  reader.skip(name, "a name");
  file.color = readCamera(reader, "the colour camera");
  file.depth = readCamera(reader, "the depth camera");
  file.color_compression = colorCompression(reader);
  file.depth_compression = depthCompression(path, reader);
  readSize(path, reader, file.color, true);
  readSize(path, reader, file.depth, false);
  readShift(path, reader, file);
  readFrames(path, reader, file);
  return file;
}

Image<float> readSensDepth(const SensFile& file, const SensFrame& frame) {
  constexpr std::uint16_t kSaturated = 65535;
  const std::size_t size =
      2 * static_cast<std::size_t>(file.depth.width) * static_cast<std::size_t>(file.depth.height);
  if (file.depth_compression == SensDepth::Raw && frame.depth_bytes != size)
    throw IoError(file.path, byteText(frame.begin + kMatrixBytes + 24),
                  "raw depth of " + std::to_string(size) + " bytes", std::to_string(frame.depth_bytes));
  std::string bytes = io::readFilePart(file.path, frame.depth_begin, frame.depth_bytes);
  if (file.depth_compression == SensDepth::Zlib) bytes = inflated(file, frame, bytes, size);
  Image<float> depth(file.depth.width, file.depth.height);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    const auto value = static_cast<std::uint16_t>(littleEndian(bytes.data() + 2 * i, 2));
    depth.data()[i] = value == kSaturated ? 0.0F : static_cast<float>(value);
  }
  return depth;
}

Image<Rgb8> readSensColor(const SensFile& file, const SensFrame& frame) {
  if (frame.color_bytes == 0) return {};
  const int width = file.color.width, height = file.color.height;
  const std::string bytes = io::readFilePart(file.path, frame.color_begin, frame.color_bytes);
  const io::EncodedPicture picture{file.path, byteText(frame.color_begin), bytes, width, height};
  if (file.color_compression == SensColor::Png) return io::decodePng(picture);
  if (file.color_compression == SensColor::Jpeg) return io::decodeJpeg(picture);
  const std::size_t size = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (bytes.size() != size)
    throw IoError(file.path, byteText(frame.color_begin),
                  "a raw picture of " + std::to_string(size) + " bytes", std::to_string(bytes.size()));
  Image<Rgb8> image(width, height);
  std::memcpy(image.data(), bytes.data(), size);
  return image;
}

}  // namespace vdbfuse
