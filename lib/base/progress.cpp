// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/progress.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/memory.h"

namespace vdbfuse {
namespace {

double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

void Progress::report(std::string_view step, double fraction) const {
  if (!callback_) return;
  const std::lock_guard lock(mutex_);
  if (!callback_(step, fraction)) throw Cancelled();
}

ProgressStep::ProgressStep(const Progress& progress, std::string name, std::size_t total)
    : progress_(progress), name_(std::move(name)), total_(std::max<std::size_t>(total, 1)) {
  progress_.report(name_, 0.0);
}

void ProgressStep::advance(std::size_t amount) {
  const std::size_t done = done_.fetch_add(amount) + amount;
  progress_.report(name_, std::min(1.0, static_cast<double>(done) / static_cast<double>(total_)));
}

void StepTimer::start(std::string name) {
  close();
  steps_.push_back({std::move(name)});
  wall_start_ = wallSeconds();
  cpu_start_ = cpuSeconds();
  running_ = true;
}

std::vector<StepTime> StepTimer::finish() {
  close();
  return steps_;
}

void StepTimer::close() {
  if (!running_) return;
  steps_.back().seconds = wallSeconds() - wall_start_;
  steps_.back().cpu_seconds = cpuSeconds() - cpu_start_;
  steps_.back().peak_memory_bytes = peakMemoryBytes();
  running_ = false;
}

}  // namespace vdbfuse
