// SPDX-License-Identifier: Apache-2.0
#include "io/file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse {

std::uint64_t fileBytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw IoError(path, "", "a file", "nothing of that name");
  if (std::filesystem::is_directory(status)) throw IoError(path, "", "a file", "a folder");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw IoError(path, "cannot be read: " + error.message());
  return size;
}

std::vector<unsigned char> readFileBytes(const std::filesystem::path& path, std::size_t limit) {
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(fileBytes(path), limit));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path, std::string("cannot be opened: ") + std::strerror(errno));
  std::vector<unsigned char> bytes(size);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::size_t>(file.gcount()) != size) throw IoError(path, "cannot be read to its end");
  return bytes;
}

void writeFileBytes(const std::filesystem::path& path, std::span<const unsigned char> bytes) {
  AtomicFile target(path);
  {
    std::ofstream file(target.temporaryPath(), std::ios::binary | std::ios::trunc);
    if (!file) throw IoError(path, std::string("cannot be written: ") + std::strerror(errno));
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw IoError(path, std::string("cannot be written: ") + std::strerror(errno));
  }
  target.commit();
}

void checkImageSize(const std::filesystem::path& path, const std::string& place, std::int64_t width,
                    std::int64_t height) {
  constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
  if (width > 0 && height > 0 && width <= kMaxPixels && height <= kMaxPixels / width) return;
  throw IoError(path, place, "an image of 1 to 268435456 pixels", sizeText(width, height));
}

std::string sizeText(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace vdbfuse
