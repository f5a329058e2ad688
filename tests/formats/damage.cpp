// SPDX-License-Identifier: Apache-2.0
#include "formats/damage.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <vector>

#include "io/temporary_folder.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse::test {
namespace {

namespace fs = std::filesystem;

constexpr double kHang_s = kSanitized ? 40 : 5;

// The process's own: other work on the machine does not count. What waits for ever is for ctest to stop.
double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// No allocation above a gibibyte while it lives; the sanitizers' own memory leaves no room for a limit.
class MemoryLimit {
 public:
  MemoryLimit() {
    if (kSanitized) return;
    getrlimit(RLIMIT_AS, &before_);
    std::ifstream statm("/proc/self/statm");
    std::size_t pages = 0;
    statm >> pages;
    rlimit limit = before_;
    limit.rlim_cur = pages * 4096 + (std::size_t{1} << 30);
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() {
    if (!kSanitized) setrlimit(RLIMIT_AS, &before_);
  }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

 private:
  rlimit before_{};
};

// A number of a text, or some bytes that may be one, made into another that a header might lie with.
void lie(std::string& text, std::size_t at, Random& random) {
  static const std::vector<std::string> lies = {"-1",  "0",   "4294967295", "9223372036854775807",   "1e308",
                                                "nan", "inf", "999999999",  "../../../../etc/passwd"};
  const std::size_t digits = text.find_first_of("0123456789", at);
  if (digits == text.npos) return;
  const std::size_t end = std::min(text.find_first_not_of("0123456789.-+e", digits), text.size());
  text.replace(digits, end - digits, lies[random.below(lies.size())]);
}

void damageOnce(std::string& text, Random& random) {
  const std::size_t at = random.below(text.size());
  switch (random.below(8)) {
    case 0:
      text.erase(at, 1 + random.below(8));
      break;
    case 1:
      text.insert(at, 1 + random.below(3), static_cast<char>(random.below(256)));
      break;
    case 2:
      text.resize(at);
      break;
    case 3:
      lie(text, at, random);
      break;
    case 4:  // a binary size that is huge or negative
      text.replace(at, std::min<std::size_t>(4, text.size() - at),
                   random.below(2) ? "\xff\xff\xff\x7f" : "\xff\xff\xff\xff");
      break;
    case 5:
      text.insert(at, text.substr(random.below(text.size()), random.below(64)));
      break;
    default:
      text[at] = static_cast<char>(random.below(256));
  }
}

std::string damaged(std::string text, Random& random) {
  for (std::uint64_t count = 1 + random.below(4); count > 0 && !text.empty(); --count)
    damageOnce(text, random);
  return text;
}

std::vector<fs::path> filesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void expectReadOrRefused(
    const Sample& sample, int trials,
    const std::function<bool(const fs::path& input, const std::string& format)>& is_refused) {
  const TemporaryFolder folder;
  sample.write(folder.path());
  const std::vector<fs::path> files = filesIn(folder.path());
  ASSERT_FALSE(is_refused(folder / sample.input, sample.format));
  const MemoryLimit limit;
  Random random(7);
  int refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const fs::path& file = files[random.below(files.size())];
    const std::string good = readText(file);
    writeText(file, damaged(good, random));
    const double start_s = processorSeconds();
    ASSERT_NO_THROW(refused += is_refused(folder / sample.input, sample.format) ? 1 : 0)
        << file << ", trial " << trial;
    ASSERT_LT(processorSeconds() - start_s, kHang_s) << file << ", trial " << trial;
    writeText(file, good);
  }
  // Most bytes of most files are values, and any value is one; but not all of them.
  EXPECT_GT(refused, trials / 50);
}

}  // namespace vdbfuse::test
