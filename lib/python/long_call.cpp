// SPDX-License-Identifier: Apache-2.0
#include "python/long_call.h"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace vdbfuse::python {
namespace {

constexpr std::chrono::milliseconds kLookUpEvery{40};

struct News {
  std::string step;
  double share = 0;
};

struct Heard {
  std::vector<News> news;  ///< the last of each step
  bool ended = false;
};

// What the threads that work and the one that called them say to each other.
class Conversation {
 public:
  // False: stop.
  bool tell(std::string_view step, double share) {
    const std::lock_guard lock(mutex_);
    if (news_.empty() || news_.back().step != step) news_.push_back({std::string(step), share});
    news_.back().share = share;
    return !stopped_;
  }
  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    changed_.notify_all();
  }

  // Waits a moment.
  Heard listen() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kLookUpEvery, [&] { return ended_; });
    return {std::exchange(news_, {}), ended_};
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<News> news_;
  bool stopped_ = false, ended_ = false;
};

void answer(const Heard& heard, const py::object& progress) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (progress.is_none()) return;
  for (const News& news : heard.news) progress(news.step, news.share);
}

// Until the work has ended. Returns what was raised meanwhile on this thread.
std::exception_ptr attend(const py::object& progress, Conversation& conversation) {
  std::exception_ptr raised;
  for (bool ended = false; !ended;) {
    Heard heard;
    {
      const py::gil_scoped_release unlocked;
      heard = conversation.listen();
    }
    ended = heard.ended;
    if (raised) continue;
    try {
      answer(heard, progress);
    } catch (...) {
      raised = std::current_exception();
      conversation.stop();
    }
  }
  return raised;
}

}  // namespace

void runLong(const py::object& progress, const std::function<void(const Progress&)>& work) {
  Conversation conversation;
  std::exception_ptr thrown;
  std::thread worker([&] {
    try {
      work(Progress([&](std::string_view step, double share) { return conversation.tell(step, share); }));
    } catch (...) {
      thrown = std::current_exception();
    }
    conversation.end();
  });
  const std::exception_ptr raised = attend(progress, conversation);
  {
    const py::gil_scoped_release unlocked;
    worker.join();
  }
  if (raised) std::rethrow_exception(raised);
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace vdbfuse::python
