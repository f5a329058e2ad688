// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "vdbfuse/io/temporary_path.h"

namespace vdbfuse::tool {

/// What happens to a folder that holds something already.
enum class Existing { Refuse, Replace };

/// A folder that appears complete or not at all: fill temporaryPath(), then commit(). The temporary lies
/// beside the target and is removed when commit() was not reached.
class OutputFolder {
 public:
  /// Throws IoError when the target is a file, is not empty and not to be replaced, or cannot be made.
  OutputFolder(std::filesystem::path target, Existing existing);
  const std::filesystem::path& temporaryPath() const { return temporary_->path(); }
  /// Throws Cancelled when the run was interrupted, IoError when the folder cannot be put in place.
  void commit();

 private:
  std::filesystem::path target_;
  std::optional<TemporaryPath> temporary_;
};

/// Throws InvalidArgument when replacing the folder `output` would remove `input`; `words` say what that is.
void refuseToReplace(const std::filesystem::path& output, const std::filesystem::path& input,
                     const char* words = "the input");

}  // namespace vdbfuse::tool
