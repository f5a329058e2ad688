// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <vector>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Chunk = std::pair<std::size_t, std::size_t>;

std::multiset<Chunk> chunksOf(std::size_t count, std::size_t grain) {
  std::multiset<Chunk> chunks;
  std::mutex mutex;
  parallelFor(count, grain, [&](std::size_t begin, std::size_t end) {
    const std::lock_guard lock(mutex);
    chunks.insert({begin, end});
  });
  return chunks;
}

TEST(Parallel, EveryIndexIsVisitedOnceInTheSameChunksForOneToFourThreads) {
  for (const std::size_t count : {0u, 1u, 6u, 7u, 8u, 1000u}) {
    std::multiset<Chunk> expected;
    for (std::size_t begin = 0; begin < count; begin += 7)
      expected.insert({begin, std::min<std::size_t>(begin + 7, count)});
    EXPECT_EQ(chunkCount(count, 7), expected.size());
    for (int threads = 1; threads <= 4; ++threads) {
      const ThreadLimit limit(threads);
      EXPECT_EQ(chunksOf(count, 7), expected) << count << " on " << threads;
    }
  }
}

TEST(Parallel, AnExceptionOfABodyReachesTheCaller) {
  for (int threads = 1; threads <= 4; ++threads) {
    const ThreadLimit limit(threads);
    EXPECT_THROW(parallelFor(100, 1,
                             [](std::size_t begin, std::size_t) {
                               if (begin == 57) throw Cancelled();
                             }),
                 Cancelled);
  }
}

TEST(Parallel, AGrainOfZeroIsRefused) {
  EXPECT_THROW(parallelFor(1, 0, [](std::size_t, std::size_t) {}), InvalidArgument);
}

TEST(Parallel, TheLimitHoldsWhileItLivesAndZeroMeansAll) {
  const int all = threadCount();
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(threadCount(), 1);
    std::atomic<int> now = 0, most = 0;
    parallelFor(1000, 1, [&](std::size_t, std::size_t) {
      const int here = ++now;
      most = std::max(most.load(), here);
      --now;
    });
    EXPECT_EQ(most, 1);
  }
  EXPECT_EQ(threadCount(), all);
  const ThreadLimit none(0);
  EXPECT_EQ(threadCount(), all);
  EXPECT_THROW(ThreadLimit(-1), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
