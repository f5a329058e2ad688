// SPDX-License-Identifier: Apache-2.0
// The votes of one pixel, as vote_kernels.h promises them, one after the other.
#pragma once

#include <vector>

namespace vdbfuse::test {

struct Peak {
  float step = 0, score = 0, curvature = 1;
  int voter = 0;
  bool is_partner = true;
};

struct Mode {
  float step = 0, score = 0, support = 0, second = 0, spread2 = 0;
  int voters = 0;
};

/// C(k), all voters together.
float countAt(const std::vector<Peak>& peaks, float sigma, float step);

/// The best modes, at most `most`. REQUIRES: the peaks of a voter follow each other.
std::vector<Mode> modesOf(const std::vector<Peak>& peaks, float sigma, std::size_t most);

}  // namespace vdbfuse::test
