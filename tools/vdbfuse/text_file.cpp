// SPDX-License-Identifier: Apache-2.0
#include "text_file.h"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::tool {

void writeText(const std::filesystem::path& path, const std::string& text,
               const std::filesystem::path& name) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw IoError(name, "cannot be written: " + std::generic_category().message(errno));
}

void replaceText(const std::filesystem::path& path, const std::string& text) {
  AtomicFile target(path);
  writeText(target.temporaryPath(), text, path);
  target.commit();
}

}  // namespace vdbfuse::tool
