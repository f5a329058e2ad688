// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/scratch_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <new>
#include <string>
#include <system_error>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

std::size_t wholePages(std::size_t bytes) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return (bytes + page - 1) / page * page;
}

std::string message(int error) { return std::generic_category().message(error); }

int openNameless(const std::filesystem::path& folder) {
  std::string name = (folder / "vdbfuse-XXXXXX").string();
  const int file = mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) throw IoError(folder, "no scratch file can be made: " + message(errno));
  unlink(name.c_str());
  return file;
}

}  // namespace

std::filesystem::path ScratchMemory::defaultFolder() {
  const char* named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/var/tmp";
}

ScratchMemory::ScratchMemory(std::size_t window_bytes, const std::filesystem::path& folder)
    : window_bytes_(window_bytes), folder_(folder), file_(openNameless(folder)) {}

ScratchMemory::~ScratchMemory() { close(file_); }

void* ScratchMemory::do_allocate(std::size_t bytes, std::size_t) {
  const std::size_t size = wholePages(bytes);
  const std::lock_guard lock(mutex_);
  // Room is taken now: a write to a mapped page of a full disk would end the process.
  const int error = posix_fallocate(file_, static_cast<off_t>(end_), static_cast<off_t>(size));
  if (error != 0) {
    throw IoError(folder_, "no room for " + std::to_string((end_ + size) >> 20) +
                               " MiB of depth maps (choose another folder by TMPDIR): " + message(error));
  }
  void* address = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, static_cast<off_t>(end_));
  if (address == MAP_FAILED) throw std::bad_alloc();
  places_[address] = end_;
  end_ += size;
  return address;
}

void ScratchMemory::do_deallocate(void* address, std::size_t bytes, std::size_t) {
  const std::size_t size = wholePages(bytes);
  const std::lock_guard lock(mutex_);  // before the address is free for another piece
  munmap(address, size);
  const auto place = places_.find(address);
  // Best effort: the room comes back at the end at the latest.
  (void)fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(place->second),
                  static_cast<off_t>(size));
  places_.erase(place);
}

void ScratchMemory::letGo(const void* address, std::size_t bytes) {
  if (bytes > 0) madvise(const_cast<void*>(address), wholePages(bytes), MADV_DONTNEED);
}

}  // namespace vdbfuse
