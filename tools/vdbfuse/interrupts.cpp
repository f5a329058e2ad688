// SPDX-License-Identifier: Apache-2.0
#include "interrupts.h"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <thread>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/temporary_path.h"

namespace vdbfuse::tool {
namespace {

std::atomic<int> received{0};

constexpr int kGraceMilliseconds = 1000;

sigset_t watchedSignals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now = {};
    sigaction(signal, nullptr, &now);
    if (now.sa_handler != SIG_IGN) sigaddset(&set, signal);
  }
  return set;
}

[[noreturn]] void endNow() {
  removeTemporaryPaths();
  constexpr char kWords[] = "\nvdbfuse: interrupted\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kWords, sizeof kWords - 1);
  _exit(128 + received);
}

// Whether there is something to read from the first, or, before the time is over, from the second.
bool waitForSignal(int signals, int end, int milliseconds) {
  pollfd files[] = {{signals, POLLIN, 0}, {end, POLLIN, 0}};
  while (poll(files, 2, milliseconds) < 0) {
  }
  return (files[1].revents & POLLIN) == 0;
}

void watch(int signals, int end) {
  if (!waitForSignal(signals, end, -1)) return;
  signalfd_siginfo info = {};
  if (read(signals, &info, sizeof info) != sizeof info) return;
  received = static_cast<int>(info.ssi_signo);
  if (waitForSignal(signals, end, kGraceMilliseconds)) endNow();
}

}  // namespace

struct Interrupts::Watch {
  sigset_t set = watchedSignals();
  sigset_t before = {};
  int signals = -1, end = -1;
  std::thread thread;
};

Interrupts::Interrupts() : watch_(std::make_unique<Watch>()) {
  received = 0;
  // Writing beyond the limit of a file's size is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  Watch& w = *watch_;
  pthread_sigmask(SIG_BLOCK, &w.set, &w.before);
  w.signals = signalfd(-1, &w.set, SFD_CLOEXEC);
  w.end = eventfd(0, EFD_CLOEXEC);
  w.thread = std::thread(watch, w.signals, w.end);
}

Interrupts::~Interrupts() {
  Watch& w = *watch_;
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(w.end, &one, sizeof one);
  w.thread.join();
  close(w.signals), close(w.end);
  pthread_sigmask(SIG_SETMASK, &w.before, nullptr);
}

int interruptSignal() { return received; }

void stopIfInterrupted() {
  if (received != 0) throw Cancelled();
}

}  // namespace vdbfuse::tool
