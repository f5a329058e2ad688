// SPDX-License-Identifier: Apache-2.0
// libFuzzer's program for the readers of data sets, of depth maps and of photographs. The samples of one
// format (VDBFUSE_FUZZ_FORMAT) are written into memory-backed files once; an input is one byte that picks a
// file of them and the bytes that take its place. Then the whole set is read, all views included. Whatever is
// thrown must be a vdbfuse::Error, and what is read must not be empty. VDBFUSE_FUZZ_SEEDS names a folder that
// the files themselves are written to as first inputs.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "formats/image_samples.h"
#include "formats/samples.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"

namespace {

namespace fs = std::filesystem;

std::string contentsOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, const char* bytes, std::size_t size) {
  std::ofstream(path, std::ios::binary | std::ios::trunc).write(bytes, static_cast<std::streamsize>(size));
}

struct Target {
  fs::path file;   // that an input takes the place of
  fs::path input;  // what is read
  std::string format;
  std::string original;
  void (*read)(const fs::path& input, const std::string& format) = nullptr;
};

// A damaged file is still of its format: its reader must cope.
void readDepths(const fs::path& input, const std::string& format) {
  vdbfuse::ReadOptions options;
  options.format = format;
  const vdbfuse::DepthSet set = readDepthSet(input, options);
  if (set.views.empty()) std::abort();
  for (std::size_t i = 0; i < set.views.size(); ++i) set.views.load(i);
}

void readPhotographs(const fs::path& input, const std::string& format) {
  const vdbfuse::ImageSet set = vdbfuse::readImageSet(input, {format, {}});
  if (set.photographs.empty()) std::abort();
  for (std::size_t i = 0; i < set.photographs.size(); ++i) set.photographs.load(i);
}

fs::path scratchFolder() {
  const fs::path memory = "/dev/shm";
  return (fs::is_directory(memory) ? memory : fs::temp_directory_path()) /
         ("vdbfuse-fuzz-" + std::to_string(getpid()));
}

class Harness {
 public:
  Harness() : folder_(scratchFolder()) {
    const char* format = std::getenv("VDBFUSE_FUZZ_FORMAT");
    int number = 0;
    for (const vdbfuse::test::Sample& sample : vdbfuse::test::samples()) {
      if (format == nullptr || sample.format == format)
        add(sample, readDepths, folder_ / std::to_string(number++));
    }
    for (const vdbfuse::test::Sample& sample : vdbfuse::test::imageSamples()) {
      if (format == nullptr || sample.format == format)
        add(sample, readPhotographs, folder_ / std::to_string(number++));
    }
    if (targets_.empty() || targets_.size() > 255) {
      std::fprintf(stderr, "VDBFUSE_FUZZ_FORMAT: no sample of that format, or too many files\n");
      std::exit(1);
    }
    if (const char* seeds = std::getenv("VDBFUSE_FUZZ_SEEDS")) writeSeeds(seeds);
  }
  ~Harness() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  void run(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return;
    const Target& target = targets_[data[0] % targets_.size()];
    write(target.file, reinterpret_cast<const char*>(data + 1), size - 1);
    read(target);
    write(target.file, target.original.data(), target.original.size());
  }

 private:
  void add(const vdbfuse::test::Sample& sample, void (*read)(const fs::path&, const std::string&),
           const fs::path& folder) {
    fs::create_directories(folder);
    sample.write(folder);
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file())
        targets_.push_back({entry.path(), sample.input.empty() ? folder : folder / sample.input,
                            sample.format, contentsOf(entry.path()), read});
    }
  }

  void writeSeeds(const fs::path& folder) const {
    fs::create_directories(folder);
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      const std::string seed = static_cast<char>(i) + targets_[i].original;
      write(folder / ("seed" + std::to_string(i)), seed.data(), seed.size());
    }
  }

  static void read(const Target& target) {
    try {
      target.read(target.input, target.format);
    } catch (const vdbfuse::Error&) {
    }
  }

  fs::path folder_;
  std::vector<Target> targets_;
};

Harness& harness() {
  static Harness instance;
  return instance;
}

}  // namespace

// The names that libFuzzer looks for. NOLINTBEGIN(readability-identifier-naming)
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  static const vdbfuse::ThreadLimit one_thread(1);
  harness();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  harness().run(data, size);
  return 0;
}
// NOLINTEND(readability-identifier-naming)
