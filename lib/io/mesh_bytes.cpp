// SPDX-License-Identifier: Apache-2.0
#include "mesh_bytes.h"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::io {

namespace fs = std::filesystem;

std::string readFileBytes(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw IoError(path, "", "a file to read", "none");
  if (fs::is_directory(status)) throw IoError(path, "", "a file to read", "a folder");
  if (!fs::is_regular_file(status)) throw IoError(path, "", "a regular file to read", "a special file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path, "cannot be opened: " + std::generic_category().message(errno));
  std::string bytes(fs::file_size(path), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (static_cast<std::size_t>(file.gcount()) != bytes.size())
    throw IoError(path, "cannot be read to its end");
  return bytes;
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
