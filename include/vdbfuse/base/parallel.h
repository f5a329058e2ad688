// SPDX-License-Identifier: Apache-2.0
// Parallel loops with one promise: the chunks are the same for every number of threads, so that anything
// computed per chunk and merged in chunk order is the same to the last bit.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace vdbfuse {

/// Calls `body(begin, end)` for the chunks [k·grain, min((k+1)·grain, count)), in any order, on any thread.
/// REQUIRES: grain > 0. An exception thrown by `body` reaches the caller.
void parallelFor(std::size_t count, std::size_t grain,
                 const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Number of chunks that parallelFor makes.
inline std::size_t chunkCount(std::size_t count, std::size_t grain) { return (count + grain - 1) / grain; }

/// Number of threads that parallelFor may use now.
int threadCount();

/// Limits the number of threads while it lives; 0 means all processors.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
