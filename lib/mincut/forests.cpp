// SPDX-License-Identifier: Apache-2.0
#include "forests.h"

#include "forests_grow.h"
#include "forests_mend.h"
#include "forests_push.h"

namespace vdbfuse::mincut {
namespace {

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

}  // namespace

ForestNodes::ForestNodes(const State& state)
    : level(state.excess.size()), parent(state.excess.size()), listed_parent(state.row_starts.size() - 1) {
  // The tile without nodes is beyond all regions; nothing in it ever has a level.
  for (std::size_t i = level.size() - lattice::kSlots; i < level.size(); ++i) level[i] = 0, parent[i] = kRoot;
}

template <bool R>
void Forests<R>::report() {
  const auto slots = static_cast<double>(last_ - first_) * lattice::kSlots;
  const double scanned = static_cast<double>(statistics_.scans) / (slots + 1.0);
  progress_.report("minimum cut", scanned / (1.0 + scanned));
}

template <bool R>
std::size_t Forests<R>::bytes() const {
  std::size_t bytes = bytesOf(detached_) + bytesOf(loaded_) + bytesOf(path_) + loads_.bytes();
  for (const LevelQueue& queue : orphans_) bytes += queue.bytes();
  for (const Frontier& f : frontiers_) bytes += bytesOf(f.fronts) + bytesOf(f.tiles[0]) + bytesOf(f.tiles[1]);
  return bytes;
}

template class Forests<false>;
template class Forests<true>;

}  // namespace vdbfuse::mincut
