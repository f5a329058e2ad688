// SPDX-License-Identifier: Apache-2.0
#include "file_bytes.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <limits>
#include <system_error>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::io {

namespace fs = std::filesystem;

std::uint64_t fileSize(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw IoError(path, "", "a file to read", "none");
  if (fs::is_directory(status)) throw IoError(path, "", "a file to read", "a folder");
  if (!fs::is_regular_file(status)) throw IoError(path, "", "a regular file to read", "a special file");
  const std::uint64_t size = fs::file_size(path, error);
  if (error) throw IoError(path, "cannot be read: " + error.message());
  return size;
}

std::string readFileStart(const fs::path& path, std::size_t count) {
  std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(fileSize(path), count)), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path, "cannot be opened: " + std::generic_category().message(errno));
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::size_t>(file.gcount()) != bytes.size())
    throw IoError(path, "cannot be read to its end");
  return bytes;
}

std::string readFilePart(const fs::path& path, std::uint64_t offset, std::uint64_t count) {
  const std::uint64_t size = fileSize(path);
  if (offset > size || count > size - offset)
    throw IoError(path, "byte " + std::to_string(size),
                  std::to_string(count) + " bytes from byte " + std::to_string(offset) + " on",
                  "the end of the file");
  std::string bytes(static_cast<std::size_t>(count), '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path, "cannot be opened: " + std::generic_category().message(errno));
  file.seekg(static_cast<std::streamoff>(offset));
  if (!file.read(bytes.data(), static_cast<std::streamsize>(count)))
    throw IoError(path, "cannot be read to its end");
  return bytes;
}

std::string readFileBytes(const fs::path& path) {
  return readFileStart(path, std::numeric_limits<std::size_t>::max());
}

void writeFileBytes(const fs::path& path, std::string_view bytes) {
  AtomicFile target(path);
  std::ofstream file(target.temporaryPath(), std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw IoError(path, "cannot be written: " + std::generic_category().message(errno));
  target.commit();
}

}  // namespace vdbfuse::io
