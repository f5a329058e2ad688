// SPDX-License-Identifier: Apache-2.0
// Calls that take long: other threads of Python run meanwhile, Ctrl-C stops them, and they tell where they
// are.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "python/binding.h"
#include "vdbfuse/base/progress.h"

namespace vdbfuse::python {

/// Runs `work` on a thread of its own. The thread of the call lets go of the interpreter's lock and looks up
/// every few hundredths of a second: it handles signals, and calls progress(step, share) unless that is None
/// — for every step at least once, always on this one thread. What either raises, Ctrl-C's KeyboardInterrupt
/// too, stops the work and is raised when it has ended; then what `work` threw. REQUIRES: the lock is held.
void runLong(const py::object& progress, const std::function<void(const Progress&)>& work);

/// The same for work that returns something.
template <class Work>
auto longCall(const py::object& progress, const Work& work) {
  std::optional<std::invoke_result_t<const Work&, const Progress&>> result;
  runLong(progress, [&](const Progress& inner) { result.emplace(work(inner)); });
  return std::move(*result);
}

}  // namespace vdbfuse::python
