// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/memory.h"

#include <sys/resource.h>
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace vdbfuse {
namespace {

constexpr std::size_t kUnknownSize = std::numeric_limits<std::size_t>::max();

std::size_t availableOfSystem() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("MemAvailable:")) return std::stoull(line.substr(13)) * 1024;
  }
  return kUnknownSize;
}

std::optional<std::size_t> numberIn(const std::string& path) {
  std::ifstream file(path);
  std::size_t number = 0;
  if (file >> number) return number;
  return std::nullopt;  // no such file, or "max"
}

// Of the control group whose files a container sees at the usual place.
std::size_t availableOfGroup(const std::string& limit_file, const std::string& usage_file) {
  const auto limit = numberIn(limit_file), usage = numberIn(usage_file);
  if (!limit || !usage) return kUnknownSize;
  return *limit > *usage ? *limit - *usage : 0;
}

}  // namespace

std::size_t availableMemoryBytes() {
  return std::min({availableOfSystem(),
                   availableOfGroup("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"),
                   availableOfGroup("/sys/fs/cgroup/memory/memory.limit_in_bytes",
                                    "/sys/fs/cgroup/memory/memory.usage_in_bytes")});
}

std::size_t peakMemoryBytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

PeakMemory restartPeakMemory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  // Linux, proc(5): 5 resets the peak of the resident set.
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file ? PeakMemory::Restarted : PeakMemory::SinceTheStart;
}

std::string sizeText(std::size_t bytes) {
  const double mib = static_cast<double>(bytes) / 0x1p20;
  char text[32];
  std::snprintf(text, sizeof text, mib < 1024 ? "%.0f MiB" : "%.3g GiB", mib < 1024 ? mib : mib / 1024);
  return text;
}

}  // namespace vdbfuse
