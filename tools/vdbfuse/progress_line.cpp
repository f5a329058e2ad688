// SPDX-License-Identifier: Apache-2.0
#include "progress_line.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "interrupts.h"

namespace vdbfuse::tool {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool wantsJson() {
  const char* wish = std::getenv("VDBFUSE_PROGRESS");
  return wish != nullptr && std::strcmp(wish, "json") == 0;
}

}  // namespace

double TimeLeft::after(const std::string& step, double fraction, double seconds) const {
  constexpr double kLeastDone = 0.1;
  double done = 0, all = 0;
  bool is_known = false;
  for (const StepShare& s : steps_) {
    if (s.name == step) is_known = true, done = all + fraction * s.share;
    all += s.share;
  }
  if (!is_known || done < kLeastDone * all) return -1;
  return seconds * (all - done) / done;
}

ProgressLine::ProgressLine(bool quiet, std::vector<StepShare> steps)
    : style_(wantsJson()                            ? Style::JsonLines
             : !quiet && isatty(STDERR_FILENO) != 0 ? Style::Terminal
                                                    : Style::Silent),
      time_left_(std::move(steps)),
      began_(now()),
      expecting_since_(began_),
      progress_([this](std::string_view step, double fraction) { return show(step, fraction); }) {}

ProgressLine::~ProgressLine() {
  if (style_ == Style::Terminal) std::fputs("\r\033[K", stderr);
}

bool ProgressLine::show(std::string_view step, double fraction) {
  constexpr double kInterval = 0.1;
  if (interruptSignal() != 0) return false;
  if (style_ == Style::Silent) return true;
  const double time = now();
  const bool is_new = step != step_;
  if (!is_new && time - shown_ < kInterval && fraction < 1) return true;
  step_ = step, shown_ = time;
  print(fraction, time);
  return true;
}

void ProgressLine::expect(std::vector<StepShare> steps) {
  time_left_ = TimeLeft(std::move(steps));
  expecting_since_ = now();
}

void ProgressLine::print(double fraction, double time) const {
  const double left = time_left_.after(step_, fraction, time - expecting_since_);
  char left_text[32] = "null";
  if (left >= 0) std::snprintf(left_text, sizeof left_text, "%.1f", left);
  if (style_ == Style::JsonLines) {
    std::fprintf(stderr, "{\"step\":\"%s\",\"fraction\":%.3f,\"seconds\":%.2f,\"left\":%s}\n", step_.c_str(),
                 fraction, time - began_, left_text);
    return;
  }
  std::fprintf(stderr, "\r\033[K%s %3.0f %%", step_.c_str(), 100 * fraction);
  if (left >= 1) std::fprintf(stderr, ", about %.0f s left in all", left);
  std::fflush(stderr);
}

}  // namespace vdbfuse::tool
