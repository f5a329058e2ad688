// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, SIGTERM and SIGHUP: the run stops where it next asks, and what it has begun to write is removed.
#pragma once

#include <memory>

namespace vdbfuse::tool {

/// While it lives, a signal that would end the process only asks it to stop. A run that does not stop within
/// a second, because a long call does not ask, is ended with its temporary files removed; so is every run at
/// the second signal. Make it before the first thread is started. Signals that the parent process ignores
/// stay ignored (nohup).
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

 private:
  struct Watch;
  std::unique_ptr<Watch> watch_;
};

/// The signal that came; 0: none.
int interruptSignal();

/// Throws Cancelled when a signal has come: before a result is put in its place.
void stopIfInterrupted();

}  // namespace vdbfuse::tool
