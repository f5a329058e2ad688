// SPDX-License-Identifier: Apache-2.0
#include "progress_line.h"

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

namespace vdbfuse::tool {
namespace {

volatile std::sig_atomic_t interrupted = 0;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

ProgressLine::ProgressLine(bool quiet)
    : visible_(!quiet && isatty(STDERR_FILENO) != 0),
      progress_([this](std::string_view step, double fraction) { return show(step, fraction); }) {
  std::signal(SIGINT, [](int) { interrupted = 1; });
}

ProgressLine::~ProgressLine() {
  if (visible_) std::fputs("\r\033[K", stderr);
  std::signal(SIGINT, SIG_DFL);
}

bool ProgressLine::show(std::string_view step, double fraction) {
  if (interrupted != 0) return false;
  if (!visible_) return true;
  const double time = now();
  if (step != step_) step_ = step, started_ = time, shown_ = 0;
  constexpr double kInterval = 0.1, kWorthAnEstimate = 2.0;
  if (time - shown_ < kInterval && fraction < 1) return true;
  shown_ = time;
  const double spent = time - started_;
  std::fprintf(stderr, "\r\033[K%s %3.0f %%", step_.c_str(), 100 * fraction);
  if (spent > kWorthAnEstimate && fraction > 0 && fraction < 1) {
    std::fprintf(stderr, ", %.0f s left", spent * (1 - fraction) / fraction);
  }
  std::fflush(stderr);
  return true;
}

}  // namespace vdbfuse::tool
