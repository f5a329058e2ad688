// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

std::string errorText(int code) { return std::generic_category().message(code); }

fs::path followLink(const fs::path& target) {
  std::error_code error;
  if (!fs::is_symlink(target, error)) return target;
  const fs::path followed = fs::weakly_canonical(target, error);
  return error ? target : followed;
}

// Renaming over a device (/dev/null) would replace the device itself.
void refuseUnlessRegularOrNew(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (!fs::exists(status)) return;
  if (fs::is_directory(status)) throw IoError(target, "", "a file to write", "a folder");
  if (!fs::is_regular_file(status)) throw IoError(target, "", "a regular file to write", "a special file");
  if (access(target.c_str(), W_OK) != 0) throw IoError(target, "", "a writable file", errorText(errno));
}

// Not mkstemp: its files are readable by their owner only, whatever the umask.
std::unique_ptr<TemporaryPath> createBeside(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  for (;;) {
    const std::string unique = ".partial-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
    const fs::path name = "." + target.stem().string() + unique + target.extension().string();
    auto temporary = std::make_unique<TemporaryPath>(target.parent_path() / name);
    const int file = open(temporary->path().c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      close(file);
      return temporary;
    }
    const int problem = errno;
    temporary->keep();  // it is another's, or there is none
    if (problem != EEXIST) throw IoError(target, "", "a folder that can be written to", errorText(problem));
  }
}

// What an error says behind "PATH: " or "PATH, ".
std::string withoutPath(std::string message, const fs::path& path) {
  if (message.starts_with(path.string())) message.erase(0, path.string().size());
  message.erase(0, message.find_first_not_of(":, "));
  return message;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(followLink(target)) {
  if (!target_.has_filename()) throw IoError(target_, "", "the name of a file to write", "none");
  refuseUnlessRegularOrNew(target_);
  temporary_ = createBeside(target_);
}

void AtomicFile::commit() {
  std::error_code error;
  fs::rename(temporary_->path(), target_, error);
  if (error) throw IoError(target_, "cannot be put in place: " + error.message());
  temporary_->keep();
}

void writeTogether(const std::vector<Output>& outputs) {
  std::vector<std::unique_ptr<AtomicFile>> files;
  for (const Output& output : outputs) {
    files.push_back(std::make_unique<AtomicFile>(output.target));
    const fs::path& temporary = files.back()->temporaryPath();
    try {
      output.write(temporary);
    } catch (const IoError& error) {
      throw IoError(output.target, withoutPath(error.what(), temporary));
    }
  }
  for (const std::unique_ptr<AtomicFile>& file : files) file->commit();
}

}  // namespace vdbfuse
