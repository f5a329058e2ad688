// SPDX-License-Identifier: Apache-2.0
// Seeded random numbers that are the same on every machine and for every number of threads: make one
// generator a unit of work (a view, a row), with the unit's index as its stream.
#pragma once

#include <cstdint>

namespace vdbfuse {

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): one 64-bit state, a new stream a (seed, stream) pair.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);
  /// 64 random bits.
  std::uint64_t next();
  /// Uniform in [0, 1).
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Normal with mean 0 and standard deviation 1 (Box–Muller).
  double normal();
  /// Uniform in {0 … count−1}. REQUIRES: count > 0.
  std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }

 private:
  std::uint64_t state_;
};

}  // namespace vdbfuse
