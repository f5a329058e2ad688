// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/progress.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/memory.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

TEST(Progress, AStepReportsNothingDoneThenEachShareAndNeverMoreThanAll) {
  std::vector<std::pair<std::string, double>> seen;
  const Progress progress([&](std::string_view step, double share) {
    seen.emplace_back(step, share);
    return true;
  });
  ProgressStep step(progress, "work", 4);
  step.advance();
  step.advance(3);
  step.advance();
  const std::vector<std::pair<std::string, double>> expected = {
      {"work", 0.0}, {"work", 0.25}, {"work", 1.0}, {"work", 1.0}};
  EXPECT_EQ(seen, expected);
}

TEST(Progress, SayingNoCancelsALoopOnAnyNumberOfThreads) {
  for (int threads = 1; threads <= 4; ++threads) {
    const ThreadLimit limit(threads);
    const Progress progress([](std::string_view, double share) { return share < 0.5; });
    ProgressStep step(progress, "work", 1000);
    EXPECT_THROW(parallelFor(1000, 1, [&](std::size_t, std::size_t) { step.advance(); }), Cancelled);
  }
}

TEST(Progress, TheCallbackIsNeverEnteredTwiceAtOnce) {
  std::atomic<int> inside = 0;
  bool overlapped = false;
  const Progress progress([&](std::string_view, double) {
    overlapped |= ++inside > 1;
    --inside;
    return true;
  });
  ProgressStep step(progress, "work", 1000);
  const ThreadLimit limit(4);
  parallelFor(1000, 1, [&](std::size_t, std::size_t) { step.advance(); });
  EXPECT_FALSE(overlapped);
}

TEST(Progress, AStepOfNothingIsAllowedAndNobodyNeedsToListen) {
  const Progress progress;
  ProgressStep step(progress, "nothing", 0);
  EXPECT_NO_THROW(step.advance());
}

TEST(StepTimer, StepsComeBackInOrderWithTheirTimes) {
  StepTimer timer;
  EXPECT_TRUE(timer.finish().empty());
  timer.start("first");
  volatile double x = 0;
  for (int i = 0; i < 2000000; ++i) x = x + i;
  timer.start("second");
  const std::vector<StepTime> steps = timer.finish();
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].name, "first");
  EXPECT_EQ(steps[1].name, "second");
  EXPECT_GT(steps[0].seconds, 0);
  EXPECT_GE(steps[0].cpu_seconds, 0);
}

TEST(AvailableMemory, IsMoreThanNothingAndLessThanAnyMachineHas) {
  EXPECT_GT(availableMemoryBytes(), std::size_t{16} << 20);
  EXPECT_LT(availableMemoryBytes(), std::size_t{1} << 50);
}

TEST(PeakMemory, GrowsWithWhatIsTouched) {
  const std::size_t before = peakMemoryBytes();
  const std::vector<char> block(64u << 20, 1);
  EXPECT_GE(peakMemoryBytes() + (4u << 20), before + block.size() * static_cast<std::size_t>(block[5]) / 2);
  EXPECT_GE(peakMemoryBytes(), block.size());
}

TEST(PeakMemory, CountsAnewFromWhatIsInUse) {
  // Straight from the system and back to it: an allocator may keep what it is given back (sanitizers do).
  constexpr std::size_t kBytes = std::size_t{128} << 20;
  void* block = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(block, MAP_FAILED);
  std::memset(block, 1, kBytes);
  ASSERT_EQ(munmap(block, kBytes), 0);
  const std::size_t before = peakMemoryBytes();
  if (restartPeakMemory() == PeakMemory::SinceTheStart) GTEST_SKIP() << "the system does not tell";
  EXPECT_LT(peakMemoryBytes() + (64u << 20), before);
}

}  // namespace
}  // namespace vdbfuse
