// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vdbfuse {

/// A file or folder that does not outlive this object, unless keep() is called. Making it creates nothing.
class TemporaryPath {
 public:
  explicit TemporaryPath(std::filesystem::path path);
  /// Removes the path with all that is in it, if it is there.
  ~TemporaryPath();
  TemporaryPath(const TemporaryPath&) = delete;
  TemporaryPath& operator=(const TemporaryPath&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// It has got its final name, or is gone: nothing is removed any more.
  void keep();

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

/// Removes what all TemporaryPath objects of this process stand for, now: for a process that is about to end
/// without running their destructors, because a signal says so and a long call does not come back. May be
/// called from any thread, while others write there.
void removeTemporaryPaths() noexcept;

}  // namespace vdbfuse
