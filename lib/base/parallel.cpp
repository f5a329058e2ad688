// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {

void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body) {
  if (grain == 0) throw InvalidArgument("grain", "must be positive");
  tbb::parallel_for(std::size_t{0}, chunkCount(count, grain),
                    [&](std::size_t chunk) { body(chunk * grain, std::min((chunk + 1) * grain, count)); });
}

int threadCount() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

struct ThreadLimit::Impl {
  std::optional<tbb::global_control> control;
};

ThreadLimit::ThreadLimit(int threads) : impl_(std::make_unique<Impl>()) {
  if (threads < 0) throw InvalidArgument("threads", "must not be negative");
  if (threads > 0) {
    impl_->control.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace vdbfuse
