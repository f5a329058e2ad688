// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/temporary_path.h"

#include <mutex>
#include <set>
#include <system_error>
#include <utility>

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

// The paths that are to be removed. Never destroyed: a process may end while it is in use.
struct Registry {
  std::mutex mutex;
  std::set<fs::path> paths;
};

Registry& registry() {
  static auto* registry = new Registry;
  return *registry;
}

// Under another name first: who writes into a folder by its name makes nothing in it any more.
void removeNow(const fs::path& path) {
  std::error_code ignored;
  fs::path away = path;
  away += ".gone";
  fs::rename(path, away, ignored);
  fs::remove_all(away, ignored);
}

}  // namespace

TemporaryPath::TemporaryPath(fs::path path) : path_(fs::absolute(path)) {
  const std::lock_guard lock(registry().mutex);
  registry().paths.insert(path_);
}

TemporaryPath::~TemporaryPath() {
  if (kept_) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  keep();
}

void TemporaryPath::keep() {
  const std::lock_guard lock(registry().mutex);
  registry().paths.erase(path_);
  kept_ = true;
}

void removeTemporaryPaths() noexcept {
  try {
    const std::lock_guard lock(registry().mutex);
    // Twice: a file may have been opened by its name between the two.
    for (int pass = 0; pass < 2; ++pass)
      for (const fs::path& path : registry().paths) removeNow(path);
  } catch (const std::exception&) {
    // The process ends; nobody can be told.
  }
}

}  // namespace vdbfuse
