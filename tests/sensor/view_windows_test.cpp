// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/view_windows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <set>

#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

// Views of 10 × 10 pixels, 400 bytes each.
std::vector<View> smallViews(std::size_t count, std::pmr::memory_resource* memory) {
  std::vector<View> views(count);
  for (std::size_t i = 0; i < count; ++i) {
    views[i].map.depth = Image<float>(10, 10, 1.0f + static_cast<float>(i));
    keepIn(memory, views[i]);
  }
  return views;
}

std::vector<std::size_t> windowSizes(const std::vector<View>& views) {
  std::vector<std::size_t> sizes;
  std::size_t next = 0;
  forEachWindow(views, [&](std::size_t begin, std::size_t end) {
    EXPECT_EQ(begin, next);
    sizes.push_back((next = end) - begin);
  });
  EXPECT_EQ(next, views.size());
  return sizes;
}

TEST(ForEachWindow, InPlainMemoryAllViewsAreOneWindow) {
  EXPECT_EQ(windowSizes(smallViews(7, std::pmr::new_delete_resource())), std::vector<std::size_t>{7});
}

TEST(ForEachWindow, InScratchMemoryWindowsHoldAsMuchAsTheyMay) {
  ScratchMemory memory(1300);
  EXPECT_EQ(windowSizes(smallViews(7, &memory)), (std::vector<std::size_t>{3, 3, 1}));
  ScratchMemory tiny(100);
  EXPECT_EQ(windowSizes(smallViews(3, &tiny)), (std::vector<std::size_t>{1, 1, 1}));
}

TEST(ForEachWindow, ViewsAreTheSameAfterTheyWereLetGo) {
  ScratchMemory memory(500);
  const std::vector<View> views = smallViews(5, &memory);
  for (int pass = 0; pass < 2; ++pass) {
    forEachWindow(views, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        EXPECT_EQ(views[i].map.depth, Image<float>(10, 10, 1.0f + static_cast<float>(i)));
    });
  }
}

TEST(KeepIn, AMovedImageStaysInItsMemoryAndACopyDoesNot) {
  ScratchMemory memory(500);
  std::vector<View> views = smallViews(1, &memory);
  EXPECT_EQ(views[0].memory(), &memory);
  Image<float> moved;
  moved = std::move(views[0].map.depth);
  EXPECT_EQ(moved.memory(), &memory);
  const Image<float> copy = moved;  // NOLINT: the copy is what is tested
  EXPECT_NE(copy.memory(), &memory);
  EXPECT_EQ(copy, moved);
}

struct RandomNeighbourhoods {
  Neighbourhoods n;
  std::vector<std::size_t> sizes;
  explicit RandomNeighbourhoods(std::uint64_t seed) {
    Random random(seed);
    const std::size_t count = 1 + random.below(30);
    n.order.resize(count);
    std::iota(n.order.begin(), n.order.end(), std::size_t{0});
    std::reverse(n.order.begin(), n.order.end());
    n.needed.resize(count);
    for (auto& needed : n.needed)
      for (std::size_t k = random.below(5); k > 0; --k) needed.push_back(random.below(count));
    for (std::size_t i = 0; i < count; ++i) sizes.push_back(1 + random.below(20));
    n.limit = 40;
    n.bytes = [this](std::size_t i) { return sizes[i]; };
  }
  std::size_t bytesOf(const std::vector<std::size_t>& group) const {
    std::set<std::size_t> all(group.begin(), group.end());
    for (const std::size_t i : group) all.insert(n.needed[i].begin(), n.needed[i].end());
    return std::accumulate(all.begin(), all.end(), std::size_t{0},
                           [&](std::size_t sum, std::size_t i) { return sum + sizes[i]; });
  }
};

TEST(GroupsOf, HoldEveryViewOnceWithinTheLimitAndAreAsLargeAsTheyMayBe) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RandomNeighbourhoods random(seed);
    const auto groups = groupsOf(random.n);
    std::vector<std::size_t> all;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      all.insert(all.end(), groups[g].begin(), groups[g].end());
      EXPECT_TRUE(groups[g].size() == 1 || random.bytesOf(groups[g]) <= random.n.limit) << seed;
      if (g + 1 == groups.size()) continue;
      std::vector<std::size_t> more = groups[g];
      more.push_back(groups[g + 1].front());
      EXPECT_GT(random.bytesOf(more), random.n.limit) << seed;
    }
    EXPECT_EQ(all, random.n.order) << seed;
  }
}

TEST(ForEachNeighbourhood, VisitsAllAndLetsGoOfAllThatWasNeeded) {
  RandomNeighbourhoods random(4);
  std::mutex mutex;
  std::multiset<std::size_t> visited;
  std::set<std::size_t> gone;
  random.n.let_go = [&](std::size_t i) { gone.insert(i); };
  forEachNeighbourhood(random.n, [&](std::size_t i) {
    const std::lock_guard lock(mutex);
    visited.insert(i);
  });
  EXPECT_EQ(visited.size(), random.n.order.size());
  EXPECT_EQ(gone.size(), random.n.order.size());
}

}  // namespace
}  // namespace vdbfuse
