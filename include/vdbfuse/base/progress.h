// SPDX-License-Identifier: Apache-2.0
// How a long call tells where it is, and how it is told to stop.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace vdbfuse {

/// Handed to long calls. A default-constructed object reports to nobody and never stops.
class Progress {
 public:
  /// Called with the name of the step and the share of it that is done, in [0, 1]; returns false to stop.
  /// Never called from two threads at once.
  using Callback = std::function<bool(std::string_view step, double fraction)>;

  Progress() = default;
  explicit Progress(Callback callback) : callback_(std::move(callback)) {}

  /// Throws Cancelled when the callback says so.
  void report(std::string_view step, double fraction) const;

 private:
  Callback callback_;
  mutable std::mutex mutex_;
};

/// One step of a long call: reports 0 when made, and the share done at each advance().
class ProgressStep {
 public:
  ProgressStep(const Progress& progress, std::string name, std::size_t total);
  /// Safe from any thread. Throws Cancelled when the callback asks to stop.
  void advance(std::size_t amount = 1);

 private:
  const Progress& progress_;
  std::string name_;
  std::size_t total_;
  std::atomic<std::size_t> done_{0};
};

/// Wall and processor time of one named step, and memory.
struct StepTime {
  std::string name;
  double seconds = 0.0;               ///< wall clock
  double cpu_seconds = 0.0;           ///< all threads of the process
  std::size_t peak_memory_bytes = 0;  ///< peakMemoryBytes() at its end
};

/// Measures consecutive steps: start() ends the step before it.
class StepTimer {
 public:
  void start(std::string name);
  /// Ends the running step and returns all of them in order.
  std::vector<StepTime> finish();

 private:
  void close();
  std::vector<StepTime> steps_;
  double wall_start_ = 0.0;
  double cpu_start_ = 0.0;
  bool running_ = false;
};

}  // namespace vdbfuse
