// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/base/progress.h"

namespace vdbfuse::tool {

/// Shows the running step with its share and the time left on one line of stderr, when that is a terminal,
/// and stops the run when the user presses Ctrl-C.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  const Progress& progress() const { return progress_; }

 private:
  bool show(std::string_view step, double fraction);
  bool visible_;
  std::string step_;
  double started_ = 0, shown_ = 0;
  Progress progress_;
};

}  // namespace vdbfuse::tool
