// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "vdbfuse/io/temporary_path.h"

namespace vdbfuse {

/// A file that appears complete or not at all: write to `temporaryPath()`, close, then `commit()`. The
/// temporary lies beside the target, has the target's extension, and is removed when `commit()` was not
/// reached. A target that exists is replaced; a symbolic link is followed, so that the file it names is
/// replaced.
class AtomicFile {
 public:
  /// Creates the empty temporary. IoError when the target is a folder, a device, or cannot be written.
  explicit AtomicFile(std::filesystem::path target);
  const std::filesystem::path& temporaryPath() const { return temporary_->path(); }
  /// Renames the temporary to the target. Throws IoError; the temporary is then removed by the destructor.
  void commit();

 private:
  std::filesystem::path target_;
  std::unique_ptr<TemporaryPath> temporary_;
};

/// A file to write and how: `write` gets the path of a temporary with the same extension.
struct Output {
  std::filesystem::path target;
  std::function<void(const std::filesystem::path& temporary)> write;
};

/// Writes all of them before the first one is put in place: a disk that fills up leaves none, and the files
/// that were there survive. Throws what `write` throws, with the target's name in place of the temporary's;
/// IoError.
void writeTogether(const std::vector<Output>& outputs);

}  // namespace vdbfuse
