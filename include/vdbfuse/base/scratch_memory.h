// SPDX-License-Identifier: Apache-2.0
// Memory for what does not fit: pages of a temporary file, which leave and come back as they are used.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory_resource>
#include <mutex>

namespace vdbfuse {

/// Hands out memory that is backed by a file without a name. What was let go of stays in the file and comes
/// back when it is touched; the file goes with the object, or with the process. Fit for images, not for small
/// things: every piece is a mapping of whole pages. Safe from any thread. Must outlive what it gave.
class ScratchMemory final : public std::pmr::memory_resource {
 public:
  /// Whoever walks through memory of this kind should let go of it every `window_bytes`. Throws IoError when
  /// no file can be made in `folder`.
  explicit ScratchMemory(std::size_t window_bytes, const std::filesystem::path& folder = defaultFolder());
  ~ScratchMemory() override;
  ScratchMemory(const ScratchMemory&) = delete;
  ScratchMemory& operator=(const ScratchMemory&) = delete;

  std::size_t windowBytes() const { return window_bytes_; }

  /// The bytes leave this process's memory until they are used again; their values stay. Other threads may be
  /// reading them meanwhile.
  static void letGo(const void* address, std::size_t bytes);

  /// $TMPDIR, or /var/tmp, which is on a disk where /tmp may be memory.
  static std::filesystem::path defaultFolder();

 private:
  /// Throws IoError when the disk is full.
  void* do_allocate(std::size_t bytes, std::size_t alignment) override;
  void do_deallocate(void* address, std::size_t bytes, std::size_t alignment) override;
  bool do_is_equal(const std::pmr::memory_resource& other) const noexcept override { return this == &other; }

  std::size_t window_bytes_;
  std::filesystem::path folder_;
  int file_ = -1;
  std::mutex mutex_;
  std::size_t end_ = 0;                        ///< of the file
  std::map<const void*, std::size_t> places_;  ///< in the file, of all pieces
};

}  // namespace vdbfuse
