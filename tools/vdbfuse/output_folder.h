// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vdbfuse::tool {

/// What happens to a folder that holds something already.
enum class Existing { Refuse, Replace };

/// A folder that appears complete or not at all: fill temporaryPath(), then commit(). The temporary lies
/// beside the target and is removed when commit() was not reached.
class OutputFolder {
 public:
  /// Throws IoError when the target is a file, is not empty and not to be replaced, or cannot be made.
  OutputFolder(std::filesystem::path target, Existing existing);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& temporaryPath() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path target_, temporary_;
};

/// Throws InvalidArgument when replacing the folder `output` would remove `input`; `words` say what that is.
void refuseToReplace(const std::filesystem::path& output, const std::filesystem::path& input,
                     const char* words = "the input");

}  // namespace vdbfuse::tool
