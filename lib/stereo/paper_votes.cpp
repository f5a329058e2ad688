// SPDX-License-Identifier: Apache-2.0
#include "stereo/paper_votes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "stereo/matching_constants.h"
#include "stereo/paper_curve.h"

namespace vdbfuse::stereo::paper {
namespace {

double weight(double distance) { return std::exp(-distance * distance / (2 * kVoteSigma * kVoteSigma)); }

// C has its maxima where the weighted mean of the votes lies in the middle (Cheng 1995).
double meanShift(const std::vector<Vote>& votes, double step) {
  constexpr int kMostIterations = 500;
  constexpr double kStill = 1e-7;
  for (int i = 0; i < kMostIterations; ++i) {
    double sum = 0, total = 0;
    for (const Vote& vote : votes) {
      const double share = vote.score * weight(step - vote.step);
      sum += share * vote.step;
      total += share;
    }
    const double moved = sum / total - step;
    step += moved;
    if (std::abs(moved) < kStill) break;
  }
  return step;
}

std::vector<Mode> bestApart(std::vector<Mode> modes) {
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return a.score > b.score; });
  std::vector<Mode> apart;
  for (const Mode& mode : modes)
    if (std::all_of(apart.begin(), apart.end(),
                    [&](const Mode& better) { return std::abs(better.step - mode.step) > 3 * kVoteSigma; }))
      apart.push_back(mode);
  return apart;
}

}  // namespace

std::vector<Vote> localMaxima(const std::vector<double>& curve, double threshold, std::size_t partner) {
  std::vector<Vote> maxima;
  for (std::size_t k = 1; k + 1 < curve.size(); ++k) {
    const double before = curve[k - 1], here = curve[k], after = curve[k + 1];
    if (before == kNoScore || after == kNoScore) continue;
    if (!(here > threshold && here >= before && here > after)) continue;
    const double offset = (before - after) / (2 * (before - 2 * here + after));
    const double score = here - (before - after) * offset / 4;
    maxima.push_back({static_cast<double>(k) + offset, std::min(score, 1.0), partner});
  }
  return maxima;
}

double votesAt(const std::vector<Vote>& votes, double step) {
  double sum = 0;
  for (const Vote& vote : votes) sum += vote.score * weight(step - vote.step);
  return sum;
}

std::vector<Mode> modesOf(const std::vector<Vote>& votes) {
  std::vector<Mode> modes;
  for (const Vote& vote : votes) {
    const double step = meanShift(votes, vote.step);
    modes.push_back({step, votesAt(votes, step)});
  }
  return bestApart(std::move(modes));
}

std::vector<Mode> modesOfMean(const std::vector<std::vector<double>>& curves) {
  std::vector<double> mean(curves.empty() ? 0 : curves.front().size(), kNoScore);
  for (std::size_t k = 0; k < mean.size(); ++k) {
    double sum = 0, count = 0;
    for (const std::vector<double>& curve : curves)
      if (curve[k] != kNoScore) sum += curve[k], ++count;
    if (count > 0) mean[k] = sum / count;
  }
  std::vector<Mode> modes;
  for (const Vote& maximum : localMaxima(mean, 0, 0)) modes.push_back({maximum.step, maximum.score});
  return bestApart(std::move(modes));
}

std::size_t votersAt(const std::vector<Vote>& votes, double step) {
  std::set<std::size_t> partners;
  for (const Vote& vote : votes)
    if (std::abs(vote.step - step) <= kVoteSigma) partners.insert(vote.partner);
  return partners.size();
}

}  // namespace vdbfuse::stereo::paper
