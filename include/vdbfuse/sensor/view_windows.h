// SPDX-License-Identifier: Apache-2.0
// Walking through more views than memory holds: their images lie in ScratchMemory, and whoever has worked
// through a window of views lets go of them. In plain memory all of this does nothing.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "vdbfuse/base/scratch_memory.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

template <class T>
void letGo(const Image<T>& image) {
  if (dynamic_cast<const ScratchMemory*>(image.memory()) != nullptr)
    ScratchMemory::letGo(image.data(), image.size() * sizeof(T));
}
void letGo(const View& view);
void letGo(const JudgedView& view);

/// Puts the images of a view into `memory`.
void keepIn(std::pmr::memory_resource* memory, View& view);

/// How many bytes of views may be in memory at a time: as `memory` says, without end in plain memory.
std::size_t windowBytes(const std::pmr::memory_resource* memory);

/// Bytes of a view's images.
std::size_t imageBytes(const View& view);
std::size_t imageBytes(const JudgedView& view);

/// Calls visit(begin, end) for consecutive windows of views, in order, and lets go of each afterwards.
template <class AnyView, class Visit>
void forEachWindow(const std::vector<AnyView>& views, const Visit& visit) {
  for (std::size_t begin = 0; begin < views.size();) {
    const std::size_t limit = windowBytes(views[begin].memory());
    std::size_t end = begin + 1;
    for (std::size_t bytes = imageBytes(views[begin]); end < views.size(); ++end) {
      bytes += imageBytes(views[end]);
      if (bytes > limit) break;
    }
    visit(begin, end);
    for (; begin < end; ++begin) letGo(views[begin]);
  }
}

/// Calls visit(views[i]) for one view after the other, and lets go of it.
template <class AnyView, class Visit>
void forEachView(std::vector<AnyView>& views, const Visit& visit) {
  for (AnyView& view : views) visit(view), letGo(view);
}
template <class AnyView, class Visit>
void forEachView(const std::vector<AnyView>& views, const Visit& visit) {
  for (const AnyView& view : views) visit(view), letGo(view);
}

/// What is known of views that are worked through together with their neighbours.
struct Neighbourhoods {
  std::vector<std::size_t> order;                ///< all views; near each other where they need the same ones
  std::vector<std::vector<std::size_t>> needed;  ///< by each view, beside itself
  std::size_t limit = 0;                         ///< bytes that may be in memory at a time
  std::function<std::size_t(std::size_t view)> bytes;  ///< of a view, whoever needs it
  std::function<void(std::size_t view)> let_go;
};

/// Calls visit(i) for every view, in parallel, group by group: each with all that it needs within the limit,
/// or a single view where even that is more.
void forEachNeighbourhood(const Neighbourhoods& neighbourhoods,
                          const std::function<void(std::size_t view)>& visit);

/// The groups.
std::vector<std::vector<std::size_t>> groupsOf(const Neighbourhoods& neighbourhoods);

}  // namespace vdbfuse
