// SPDX-License-Identifier: Apache-2.0
// Nodes waiting to be processed, shallowest or deepest first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbfuse::mincut {

/// Nodes waiting to be processed, by level, each with an arc that goes with it. A node may wait more than
/// once.
class LevelQueue {
 public:
  struct Item {
    std::uint32_t node;
    std::uint32_t arc;
  };
  bool empty() const { return size_ == 0; }
  void push(Item item, std::int32_t level);
  /// Takes an item off the lowest (highest) level. REQUIRES: not empty.
  Item popLowest();
  Item popHighest();
  /// Level of the item that was taken last.
  std::int32_t level() const { return level_; }
  std::size_t bytes() const;

 private:
  struct Link {
    Item item;
    std::uint32_t next;
  };
  static constexpr std::uint32_t kEnd = 0xffffffff;
  Item pop(std::int32_t level);

  std::vector<std::uint32_t> tops_;  ///< by level: first of its links, or kEnd
  std::vector<Link> links_;          ///< emptied whenever the queue is
  std::size_t size_ = 0;
  std::int32_t lowest_ = 0;
  std::int32_t highest_ = 0;
  std::int32_t level_ = 0;
};

}  // namespace vdbfuse::mincut
