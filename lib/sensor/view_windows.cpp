// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/view_windows.h"

#include <algorithm>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

template <class T>
std::size_t bytesOf(const Image<T>& image) {
  return image.size() * sizeof(T);
}

std::size_t bytesOf(const std::vector<DepthAlternative>& alternatives) {
  std::size_t bytes = 0;
  for (const DepthAlternative& a : alternatives) bytes += bytesOf(a.depth) + bytesOf(a.share);
  return bytes;
}

template <class T>
void keepIn(std::pmr::memory_resource* memory, Image<T>& image) {
  if (!image.empty() && image.memory() != memory) image = Image<T>(image, memory);
}

void letGo(const std::vector<DepthAlternative>& alternatives) {
  for (const DepthAlternative& a : alternatives) vdbfuse::letGo(a.depth), vdbfuse::letGo(a.share);
}

}  // namespace

void letGo(const View& view) {
  letGo(view.map.depth), letGo(view.map.confidence), letGo(view.map.color), letGo(view.map.mask);
  letGo(view.map.alternatives);
}

void letGo(const JudgedView& view) {
  letGo(view.depth), letGo(view.outlier), letGo(view.incidence), letGo(view.look);
  letGo(view.alternatives);
}

void keepIn(std::pmr::memory_resource* memory, View& view) {
  keepIn(memory, view.map.depth), keepIn(memory, view.map.confidence);
  keepIn(memory, view.map.color), keepIn(memory, view.map.mask);
  for (DepthAlternative& a : view.map.alternatives) keepIn(memory, a.depth), keepIn(memory, a.share);
}

std::size_t windowBytes(const std::pmr::memory_resource* memory) {
  const auto* scratch = dynamic_cast<const ScratchMemory*>(memory);
  return scratch != nullptr ? scratch->windowBytes() : std::numeric_limits<std::size_t>::max();
}

std::size_t imageBytes(const View& view) {
  return bytesOf(view.map.depth) + bytesOf(view.map.confidence) + bytesOf(view.map.color) +
         bytesOf(view.map.mask) + bytesOf(view.map.alternatives);
}

std::size_t imageBytes(const JudgedView& view) {
  return bytesOf(view.depth) + bytesOf(view.outlier) + bytesOf(view.incidence) + bytesOf(view.look) +
         bytesOf(view.alternatives);
}

std::vector<std::vector<std::size_t>> groupsOf(const Neighbourhoods& n) {
  std::vector<std::vector<std::size_t>> groups(1);
  std::vector<std::size_t> last_group(n.needed.size(), 0);  // of each view, counted from 1
  std::size_t used = 0;
  const auto bytes_added = [&](std::size_t view) {
    std::size_t added = 0;
    const auto add = [&](std::size_t other) {
      if (last_group[other] == groups.size()) return;
      last_group[other] = groups.size();
      added += n.bytes(other);
    };
    add(view);
    std::for_each(n.needed[view].begin(), n.needed[view].end(), add);
    return added;
  };
  for (const std::size_t view : n.order) {
    used += bytes_added(view);
    if (used > n.limit && !groups.back().empty()) {
      groups.emplace_back();
      used = bytes_added(view);
    }
    groups.back().push_back(view);
  }
  return groups;
}

void forEachNeighbourhood(const Neighbourhoods& n, const std::function<void(std::size_t)>& visit) {
  for (const std::vector<std::size_t>& group : groupsOf(n)) {
    parallelFor(group.size(), 1, [&](std::size_t i, std::size_t) { visit(group[i]); });
    for (const std::size_t view : group) {
      n.let_go(view);
      std::for_each(n.needed[view].begin(), n.needed[view].end(), n.let_go);
    }
  }
}

}  // namespace vdbfuse
