// SPDX-License-Identifier: Apache-2.0
#include "fusion/learn_reliability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fusion/outlier_em.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

using T = PixelTestimony;
constexpr std::size_t kConfidences = ReliabilityModel::kConfidences;
constexpr std::size_t kOutcomes = kConfidences * T::kAnswers * T::kContinuities * T::kDenials;

struct Outcome {
  std::size_t confidence, answer, continuity, denial;
};

Outcome outcomeAt(std::size_t index) {
  const auto take = [&index](std::size_t size) {
    const std::size_t value = index % size;
    index /= size;
    return value;
  };
  const std::size_t denial = take(T::kDenials), continuity = take(T::kContinuities),
                    answer = take(T::kAnswers);
  return {index, answer, continuity, denial};
}

// How many pixels gave each answer, and how many of them the posterior so far takes for wrong.
struct AnswerCounts {
  std::array<double, T::kAnswers> all{}, bad{};

  AnswerCounts(const std::vector<double>& counts, const std::vector<float>& table) {
    for (std::size_t k = 0; k < kOutcomes; ++k) {
      const std::size_t answer = outcomeAt(k).answer;
      all[answer] += counts[k], bad[answer] += counts[k] * table[k];
    }
  }

  // p(answer | outlier)/p(answer | inlier), which leans on what is `expected` by one pixel.
  double ratio(std::size_t answer, double expected) const {
    const double total = std::accumulate(all.begin(), all.end(), 0.0),
                 bad_total = std::accumulate(bad.begin(), bad.end(), 0.0);
    return (bad[answer] + expected) / (bad_total + 1) /
           ((all[answer] - bad[answer] + 1) / (total - bad_total + 1));
  }
};

// p(answer | outlier)/p(answer | inlier), to an order of magnitude: rounded from the shares of wrong pixels
// in the scenario matrix, where factors of two change little. Chance rarely makes a neighbour agree, but the
// neighbours' own mistakes often make one see past a point that is there: one that agrees outweighs any that
// contradict. Who is neither confirmed nor contradicted is hardly known: only evidence against condemns, and
// that is to be hidden from sensors that the surface faces (a depth that drills into the object), or to be
// missed more often than the sensor misses.
class AnswerRatios {
 public:
  explicit AnswerRatios(double miss_rate) {
    static_assert(T::kAgreements == 6 && T::kContradictions == 3 && T::kOcclusions == 4);
    ratios_ = {1,     50,    100,   // nobody agrees; the first is never asked for
               0.2,   0.2,   0.4,   // one
               0.08,  0.08,  0.08,  // two
               0.04,  0.04,  0.04,  //
               0.02,  0.02,  0.02,  //
               0.005, 0.005, 0.005};
    constexpr double kMissOfOutlier = 0.4, kMostOfMisses = 30, kLeastMissRate = 0.02;
    const double one_miss = std::max(1.0, kMissOfOutlier / std::max(miss_rate, kLeastMissRate));
    for (const double hidden : {0.5, 2.0, 20.0, 200.0}) {
      for (std::size_t misses = 0; misses < T::kMisses; ++misses)
        ratios_.push_back(hidden * std::min(kMostOfMisses, std::pow(one_miss, misses)));
    }
  }
  double of(std::size_t answer) const { return ratios_[answer]; }
  // One step of Bayes' rule: to be hidden or missed says no more against a pixel than it does in these data,
  // where it may be the lot of right pixels in hollows above all. It may acquit only. On a clean scan, whose
  // few outliers are such pixels, and right, it would condemn them for being so many.
  void acquit(const AnswerCounts& counts) {
    for (std::size_t answer = T::kAgreements * T::kContradictions; answer < T::kAnswers; ++answer)
      ratios_[answer] = std::min(ratios_[answer], counts.ratio(answer, ratios_[answer]));
  }
  // What teaches how many outliers there are: who is confirmed or contradicted, and half as much (in the
  // logarithm) who is hidden or missed. That is also the lot of right pixels in hollows, and made outliers of
  // them on scans that have none: 1 % of pixels at a ratio of 200 are explained best by 0.6 % of outliers.
  double teaching(std::size_t answer) const {
    return answer < T::kAgreements * T::kContradictions ? ratios_[answer] : std::sqrt(ratios_[answer]);
  }

 private:
  std::vector<double> ratios_;
};

// Views beyond the confidences hold alternative depths: what is learned is of what was measured.
std::vector<double> countOutcomes(const Testimonies& testimonies,
                                  const std::vector<Image<std::uint8_t>>& confidence) {
  constexpr std::size_t kViewsPerTask = 8;
  std::vector<std::vector<std::uint64_t>> parts(chunkCount(confidence.size(), kViewsPerTask));
  parallelFor(confidence.size(), kViewsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t>& counts = parts[begin / kViewsPerTask];
    counts.assign(kOutcomes, 0);
    for (std::size_t i = begin; i < end; ++i) {
      const Image<T>& view = testimonies.views[i];
      const std::uint8_t* bins = confidence[i].empty() ? nullptr : confidence[i].data();
      forEachMeasured(
          view, [&](std::size_t p) { ++counts[outcome(bins == nullptr ? 0 : bins[p], view.data()[p])]; });
      letGo(view), letGo(confidence[i]);
    }
  });
  std::vector<double> sum(kOutcomes, 0.0);
  for (const auto& part : parts) {
    for (std::size_t k = 0; k < kOutcomes; ++k) sum[k] += static_cast<double>(part[k]);
  }
  return sum;
}

// One step of Bayes' rule with the histograms of denial that the posterior so far gives. EM over denial as
// well would let the classes drift: where most outliers are isolated or denied, wrong patches in front of the
// surface, which nobody denies, would end up among the inliers. Both histograms lean on that of all pixels:
// the few wrong pixels of a clean scan, which lie in its hollows, teach nothing of denial.
void hearDenial(const std::vector<double>& counts, std::vector<float>& table) {
  constexpr double kLeaning = 0.02;  // in shares of all pixels
  std::array<double, T::kDenials> all{}, bad{};
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const std::size_t bin = outcomeAt(k).denial;
    all[bin] += counts[k], bad[bin] += counts[k] * table[k];
  }
  const double total = std::accumulate(all.begin(), all.end(), 0.0) + 1;
  const double bad_total = std::accumulate(bad.begin(), bad.end(), 0.0);
  const auto ratioOf = [&](std::size_t bin) {
    const double leaning = kLeaning * all[bin] + 1.0;
    return (bad[bin] + leaning) / (bad_total + kLeaning * total) /
           ((all[bin] - bad[bin] + leaning) / (total - bad_total + kLeaning * total));
  };
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const double against = table[k] * ratioOf(outcomeAt(k).denial);
    table[k] = static_cast<float>(against / (against + 1 - table[k]));
  }
}

// Of everything that can be observed of a pixel but for denial.
std::vector<float> posteriors(const OutlierModel& model, const AnswerRatios& ratios) {
  std::vector<float> table;
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const Outcome o = outcomeAt(k);
    table.push_back(static_cast<float>(model.outlierGiven(ratios.of(o.answer), o.continuity, o.confidence)));
  }
  return table;
}

}  // namespace

ConfidenceBins::ConfidenceBins(const std::vector<View>& views) {
  search_.fill(std::numeric_limits<float>::infinity());
  // A sample is enough for twenty quantiles.
  constexpr std::size_t kSmallestStride = 7, kMostSamples = 8'000'000;
  std::size_t pixels = 0;
  for (const View& view : views) pixels += view.map.depth.size();
  const std::size_t stride = std::max(kSmallestStride, pixels / kMostSamples);
  std::vector<float> sample;
  for (const View& view : views) {
    if (view.map.confidence.empty()) return;
    for (std::size_t i = 0; i < view.map.depth.size(); i += stride) {
      const float c = view.map.confidence.data()[i];
      if (view.map.depth.data()[i] != kInvalidDepth && std::isfinite(c)) sample.push_back(c);
    }
    letGo(view);
  }
  if (sample.empty()) return;
  std::sort(sample.begin(), sample.end());
  if (sample.front() == sample.back()) return;
  for (std::size_t k = 1; k < kConfidences; ++k) ends_.push_back(sample[sample.size() * k / kConfidences]);
  std::copy(ends_.begin(), ends_.end(), search_.begin());
}

std::uint8_t ConfidenceBins::binOf(float confidence) const {
  static_assert(kConfidences <= 32);
  if (!std::isfinite(confidence)) return 0;
  // Bisection without branches: they cannot be foreseen.
  unsigned bin = 0;
  for (const unsigned half : {16u, 8u, 4u, 2u, 1u})
    bin += half * static_cast<unsigned>(search_[bin + half - 1] <= confidence);
  return static_cast<std::uint8_t>(bin);
}

std::vector<Image<std::uint8_t>> ConfidenceBins::replace(std::vector<View>& views) const {
  std::vector<Image<std::uint8_t>> bins(views.size());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    Image<float>& confidence = views[i].map.confidence;
    if (informative()) {
      bins[i] = Image<std::uint8_t>(confidence.width(), confidence.height(), 0, confidence.memory());
      std::transform(
          confidence.begin(), confidence.end(), views[i].map.depth.begin(), bins[i].begin(),
          [this](float c, float depth) { return depth == kInvalidDepth ? std::uint8_t{0} : binOf(c); });
      letGo(bins[i]);
    }
    confidence = {};
  });
  return bins;
}

void ReliabilityTable::describe(const std::vector<double>& counts) {
  std::array<double, kConfidences> all{}, bad{};
  double total = 0, bad_total = 0;
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const std::size_t c = outcomeAt(k).confidence;
    all[c] += counts[k], bad[c] += counts[k] * table_[k];
  }
  for (std::size_t c = 0; c < kConfidences; ++c) total += all[c], bad_total += bad[c];
  outlier_share_ = (bad_total + 1) / (total + 2);
  for (std::size_t c = 0; c < kConfidences; ++c)
    by_confidence_[c] = all[c] > 0 ? bad[c] / all[c] : outlier_share_;
}

ReliabilityTable learnReliability(const Testimonies& testimonies,
                                  const std::vector<Image<std::uint8_t>>& confidence) {
  const std::vector<double> counts = countOutcomes(testimonies, confidence);
  AnswerRatios ratios(testimonies.miss_rate);
  std::vector<OutlierCell> cells;
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const Outcome o = outcomeAt(k);
    if (counts[k] > 0) cells.push_back({counts[k], ratios.teaching(o.answer), o.continuity, o.confidence});
  }
  const OutlierModel model = fitOutliers(cells, T::kContinuities, kConfidences);

  ReliabilityTable result;
  result.table_ = posteriors(model, ratios);
  ratios.acquit({counts, result.table_});
  result.table_ = posteriors(model, ratios);
  hearDenial(counts, result.table_);
  result.describe(counts);
  return result;
}

}  // namespace vdbfuse
