// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/scratch_memory.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;

// Of this process, from the kernel.
std::size_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0, resident = 0;
  file >> pages >> resident;
  return resident * 4096;
}

using Numbers = std::pmr::vector<std::uint32_t>;

TEST(ScratchMemory, WhatWasLetGoComesBackAsItWas) {
  ScratchMemory memory(kMiB);
  Numbers numbers(5 * kMiB + 13, &memory);
  std::iota(numbers.begin(), numbers.end(), 7u);
  ScratchMemory::letGo(numbers.data(), numbers.size() * sizeof(std::uint32_t));
  for (std::size_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], i + 7);
}

TEST(ScratchMemory, WhatWasLetGoLeavesMemory) {
  ScratchMemory memory(kMiB);
  Numbers numbers(64 * kMiB / sizeof(std::uint32_t), 1u, &memory);
  const std::size_t full = residentBytes();
  ScratchMemory::letGo(numbers.data(), 64 * kMiB);
  EXPECT_LT(residentBytes() + 60 * kMiB, full);
}

TEST(ScratchMemory, PiecesDoNotTouchEachOther) {
  ScratchMemory memory(kMiB);
  std::vector<Numbers> pieces;
  for (std::uint32_t i = 0; i < 40; ++i) pieces.emplace_back(1000 + 37 * i, i, &memory);
  for (std::size_t i = 0; i < pieces.size(); i += 3) pieces[i] = Numbers(&memory);
  for (std::uint32_t i = 0; i < 40; ++i) {
    ScratchMemory::letGo(pieces[i].data(), pieces[i].size() * sizeof(std::uint32_t));
    EXPECT_EQ(pieces[i], Numbers(i % 3 == 0 ? 0 : 1000 + 37 * i, i));
  }
}

TEST(ScratchMemory, ManyThreadsMayAskAtOnce) {
  ScratchMemory memory(kMiB);
  std::vector<std::thread> threads;
  std::vector<int> good(4, 0);
  for (std::size_t t = 0; t < good.size(); ++t) {
    threads.emplace_back([&memory, &good, t] {
      for (std::uint32_t i = 0; i < 50; ++i) {
        const Numbers numbers(5000, i, &memory);
        ScratchMemory::letGo(numbers.data(), 5000 * sizeof(std::uint32_t));
        good[t] += std::accumulate(numbers.begin(), numbers.end(), 0u) == 5000 * i;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, std::vector<int>(4, 50));
}

TEST(ScratchMemory, AFolderThatIsNotThereIsNamed) {
  try {
    const ScratchMemory memory(kMiB, "/nowhere/at/all");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/at/all"), std::string::npos) << error.what();
  }
}

TEST(ScratchMemory, ADiskThatIsFullIsAnErrorAndNotACrash) {
  ScratchMemory memory(kMiB);
  EXPECT_THROW((void)memory.allocate(std::size_t{1} << 52), IoError);
}

}  // namespace
}  // namespace vdbfuse
