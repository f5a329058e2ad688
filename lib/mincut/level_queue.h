// SPDX-License-Identifier: Apache-2.0
// Nodes waiting to be processed, shallowest or deepest first.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vdbfuse::mincut {

/// Nodes waiting to be processed, by level, each with a way that goes with it. A node may wait more than
/// once.
class LevelQueue {
 public:
  struct Item {
    std::uint32_t node;
    std::uint32_t way;
  };
  bool empty() const { return size_ == 0; }

  void push(Item item, std::int32_t level) {
    const auto index = static_cast<std::size_t>(level);
    if (index >= tops_.size()) tops_.resize(2 * index + 1, kEnd);
    if (size_++ == 0) {
      links_.clear();
      lowest_ = highest_ = level;
    }
    lowest_ = std::min(lowest_, level);
    highest_ = std::max(highest_, level);
    links_.push_back({item, std::exchange(tops_[index], static_cast<std::uint32_t>(links_.size()))});
  }

  /// Takes an item off the lowest (highest) level. REQUIRES: not empty.
  Item popLowest() {
    while (top(lowest_) == kEnd) ++lowest_;
    return pop(lowest_);
  }
  Item popHighest() {
    while (top(highest_) == kEnd) --highest_;
    return pop(highest_);
  }
  /// Level of the item that was taken last.
  std::int32_t level() const { return level_; }
  std::size_t bytes() const {
    return tops_.capacity() * sizeof(tops_[0]) + links_.capacity() * sizeof(links_[0]);
  }

 private:
  struct Link {
    Item item;
    std::uint32_t next;
  };
  static constexpr std::uint32_t kEnd = 0xffffffff;

  std::uint32_t& top(std::int32_t level) { return tops_[static_cast<std::size_t>(level)]; }
  Item pop(std::int32_t level) {
    const Link& link = links_[top(level)];
    top(level) = link.next;
    level_ = level;
    --size_;
    return link.item;
  }

  std::vector<std::uint32_t> tops_;  ///< by level: first of its links, or kEnd
  std::vector<Link> links_;          ///< emptied whenever the queue is
  std::size_t size_ = 0;
  std::int32_t lowest_ = 0;
  std::int32_t highest_ = 0;
  std::int32_t level_ = 0;
};

}  // namespace vdbfuse::mincut
