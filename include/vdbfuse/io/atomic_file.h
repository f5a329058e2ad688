// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vdbfuse {

/// A file that appears complete or not at all: write to `temporaryPath()`, close, then `commit()`. The
/// temporary lies beside the target, has the target's extension, and is removed when `commit()` was not
/// reached. A target that exists is replaced; a symbolic link is followed, so that the file it names is
/// replaced.
class AtomicFile {
 public:
  /// Creates the empty temporary. IoError when the target is a folder, a device, or cannot be written.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::filesystem::path& temporaryPath() const { return temporary_; }
  /// Renames the temporary to the target. Throws IoError; the temporary is then removed by the destructor.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_ = false;
};

}  // namespace vdbfuse
