// SPDX-License-Identifier: Apache-2.0
#include "output_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <system_error>

#include "interrupts.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::tool {

namespace fs = std::filesystem;

namespace {

void requireFree(const fs::path& target, Existing existing) {
  if (!fs::exists(target)) return;
  if (!fs::is_directory(target)) throw IoError(target, "", "a folder to write", "a file");
  if (existing == Existing::Refuse && !fs::is_empty(target))
    throw IoError(target, "", "an empty folder (or --overwrite)", "one that is not empty");
}

// "scan/" and "scan" name the same folder; the temporary must lie beside it, not in it.
fs::path withoutTrailingSlash(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

}  // namespace

OutputFolder::OutputFolder(fs::path target, Existing existing) : target_(withoutTrailingSlash(target)) {
  requireFree(target, existing);
  temporary_.emplace(target_.parent_path() /
                     ("." + target_.filename().string() + "." + std::to_string(getpid())));
  std::error_code error;
  fs::create_directories(temporary_->path(), error);
  if (error) throw IoError(target, "cannot be created: " + error.message());
}

void OutputFolder::commit() {
  stopIfInterrupted();
  // Both exchange their names in one step, so that no moment leaves the target without a complete folder.
  const char* from = temporary_->path().c_str();
  const bool exists = fs::exists(target_);
  const int flags = exists ? RENAME_EXCHANGE : RENAME_NOREPLACE;
  if (renameat2(AT_FDCWD, from, AT_FDCWD, target_.c_str(), flags) == 0) {
    if (!exists) temporary_->keep();  // otherwise it is the old folder now, and goes
    return;
  }
  // File systems that cannot exchange.
  std::error_code error;
  fs::remove_all(target_, error);
  if (!error) fs::rename(temporary_->path(), target_, error);
  if (error) throw IoError(target_, "cannot be replaced: " + error.message());
  temporary_->keep();
}

void refuseToReplace(const fs::path& output, const fs::path& input, const char* words) {
  std::error_code ignored;
  const fs::path from = fs::weakly_canonical(input, ignored), to = fs::weakly_canonical(output, ignored);
  const auto [rest, in_input] = std::mismatch(to.begin(), to.end(), from.begin(), from.end());
  if (rest == to.end()) throw InvalidArgument("OUTDIR", std::string("holds ") + words);
}

}  // namespace vdbfuse::tool
