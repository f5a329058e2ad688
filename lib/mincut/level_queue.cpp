// SPDX-License-Identifier: Apache-2.0
#include "level_queue.h"

#include <algorithm>
#include <utility>

namespace vdbfuse::mincut {

void LevelQueue::push(Item item, std::int32_t level) {
  if (static_cast<std::size_t>(level) >= tops_.size())
    tops_.resize(2 * static_cast<std::size_t>(level) + 1, kEnd);
  if (size_ == 0) {
    links_.clear();
    lowest_ = highest_ = level;
  }
  lowest_ = std::min(lowest_, level);
  highest_ = std::max(highest_, level);
  links_.push_back({item, std::exchange(tops_[level], static_cast<std::uint32_t>(links_.size()))});
  ++size_;
}

LevelQueue::Item LevelQueue::popLowest() {
  while (tops_[lowest_] == kEnd) ++lowest_;
  return pop(lowest_);
}

LevelQueue::Item LevelQueue::popHighest() {
  while (tops_[highest_] == kEnd) --highest_;
  return pop(highest_);
}

LevelQueue::Item LevelQueue::pop(std::int32_t level) {
  const Link& link = links_[tops_[level]];
  tops_[level] = link.next;
  level_ = level;
  --size_;
  return link.item;
}

std::size_t LevelQueue::bytes() const {
  return tops_.capacity() * sizeof(tops_[0]) + links_.capacity() * sizeof(links_[0]);
}

}  // namespace vdbfuse::mincut
