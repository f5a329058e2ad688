// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "vdbfuse/base/progress.h"

namespace vdbfuse::tool {

/// Steps of a run in their order, and the part of the whole time that each takes as a rule; any sum.
struct StepShare {
  std::string name;
  double share = 0;
};

/// Seconds that a run still takes. Of a step that is not in the list, or before a tenth is done, nothing is
/// known.
class TimeLeft {
 public:
  explicit TimeLeft(std::vector<StepShare> steps) : steps_(std::move(steps)) {}
  /// `seconds`: since the first of the steps began. A negative answer: not known.
  double after(const std::string& step, double fraction, double seconds) const;

 private:
  std::vector<StepShare> steps_;
};

/// Shows the running step with its share and the time that the run still takes on one line of stderr, when
/// that is a terminal, and stops the run when it is interrupted. With VDBFUSE_PROGRESS=json in the
/// environment: lines of JSON instead, whatever stderr is.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet, std::vector<StepShare> steps = {});
  ~ProgressLine();
  const Progress& progress() const { return progress_; }
  /// What is known of the steps to come, from now on.
  void expect(std::vector<StepShare> steps);

 private:
  enum class Style { Silent, Terminal, JsonLines };
  bool show(std::string_view step, double fraction);
  void print(double fraction, double time) const;

  Style style_;
  TimeLeft time_left_;
  std::string step_;
  double began_ = 0, expecting_since_ = 0, shown_ = 0;
  Progress progress_;
};

}  // namespace vdbfuse::tool
