// SPDX-License-Identifier: Apache-2.0
#include "fusion/learn_reliability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fusion/two_class_em.h"

namespace vdbfuse {
namespace {

using T = PixelTestimony;
constexpr std::size_t kConfidences = ReliabilityModel::kConfidences;
// Everything observed of a pixel: confidence, agreement, contradiction, continuity, denial.
constexpr std::size_t kOutcomes =
    kConfidences * T::kAgreements * T::kContradictions * T::kContinuities * T::kDenials;

std::size_t outcome(std::size_t confidence, const T& t) {
  return (((confidence * T::kAgreements + t.agreement) * T::kContradictions + t.contradiction) *
              T::kContinuities +
          t.continuity) *
             T::kDenials +
         t.denial;
}

struct Outcome {
  std::size_t confidence;
  T testimony;
};

Outcome outcomeAt(std::size_t index) {
  const auto take = [&index](std::size_t size) {
    const std::size_t value = index % size;
    index /= size;
    return static_cast<std::uint8_t>(value);
  };
  Outcome result;
  result.testimony.denial = take(T::kDenials);
  result.testimony.continuity = take(T::kContinuities);
  result.testimony.contradiction = take(T::kContradictions);
  result.testimony.agreement = take(T::kAgreements);
  result.confidence = index;
  return result;
}

// The observations that are independent given the class: what the neighbours say, continuity, confidence.
JointCounts noCounts() {
  return JointCounts({T::kAgreements * T::kContradictions, T::kContinuities, kConfidences});
}

std::array<std::size_t, 3> observations(const Outcome& o) {
  const T& t = o.testimony;
  return {static_cast<std::size_t>(t.agreement) * T::kContradictions + t.contradiction, t.continuity,
          o.confidence};
}

// Chance rarely makes a neighbour agree, but the neighbours' own mistakes often make one see past a point
// that is there: one that agrees outweighs two that contradict. Who is neither confirmed nor contradicted is
// not known: only evidence against condemns. Rounded from the shares of wrong pixels in the scenario matrix.
FirstOpinion opinionOfTestimony() {
  static_assert(T::kContradictions == 3);
  FirstOpinion opinion;
  opinion.outlier = {std::nullopt, 0.9, 0.98,  // nobody agrees
                     0.05,         0.1, 0.2};  // one does
  opinion.outlier.insert(opinion.outlier.end(), 3, 0.02);
  opinion.outlier.resize(T::kAgreements * T::kContradictions, 0.005);
  return opinion;
}

std::vector<double> countOutcomes(const Testimonies& testimonies,
                                  const std::vector<Image<std::uint8_t>>& confidence) {
  std::vector<double> counts(kOutcomes, 0.0);
  // Views beyond the confidences hold alternative depths: what is learned is of what was measured.
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    const Image<T>& view = testimonies.views[i];
    for (std::size_t p = 0; p < view.size(); ++p) {
      if (!view.data()[p].measured) continue;
      counts[outcome(confidence[i].empty() ? 0 : confidence[i].data()[p], view.data()[p])] += 1;
    }
  }
  return counts;
}

// One step of Bayes' rule with the histograms of denial that the posterior so far gives. EM over denial as
// well would let the classes drift: where most outliers are isolated or denied, wrong patches in front of the
// surface, which nobody denies, would end up among the inliers.
void hearDenial(const std::vector<double>& counts, std::vector<double>& table) {
  std::array<double, T::kDenials> good, bad;
  good.fill(1.0), bad.fill(1.0);
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const std::size_t bin = outcomeAt(k).testimony.denial;
    good[bin] += counts[k] * (1 - table[k]), bad[bin] += counts[k] * table[k];
  }
  const double good_total = std::accumulate(good.begin(), good.end(), 0.0);
  const double bad_total = std::accumulate(bad.begin(), bad.end(), 0.0);
  for (std::size_t k = 0; k < kOutcomes; ++k) {
    const std::size_t bin = outcomeAt(k).testimony.denial;
    const double against = table[k] * bad[bin] / bad_total,
                 in_favour = (1 - table[k]) * good[bin] / good_total;
    table[k] = against / (against + in_favour);
  }
}

}  // namespace

ConfidenceBins::ConfidenceBins(const std::vector<View>& views) {
  constexpr std::size_t kStride = 7;  // a sample is enough for twenty quantiles
  std::vector<float> sample;
  for (const View& view : views) {
    if (view.map.confidence.empty()) return;
    for (std::size_t i = 0; i < view.map.depth.size(); i += kStride) {
      const float c = view.map.confidence.data()[i];
      if (view.map.depth.data()[i] != kInvalidDepth && std::isfinite(c)) sample.push_back(c);
    }
  }
  if (sample.empty()) return;
  std::sort(sample.begin(), sample.end());
  if (sample.front() == sample.back()) return;
  for (std::size_t k = 1; k < kConfidences; ++k) ends_.push_back(sample[sample.size() * k / kConfidences]);
}

std::uint8_t ConfidenceBins::binOf(float confidence) const {
  if (!std::isfinite(confidence)) return 0;
  return static_cast<std::uint8_t>(std::upper_bound(ends_.begin(), ends_.end(), confidence) - ends_.begin());
}

std::vector<Image<std::uint8_t>> ConfidenceBins::binAll(const std::vector<View>& views) const {
  std::vector<Image<std::uint8_t>> bins(views.size());
  if (!informative()) return bins;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Image<float>& confidence = views[i].map.confidence;
    bins[i] = Image<std::uint8_t>(confidence.width(), confidence.height());
    std::transform(confidence.begin(), confidence.end(), bins[i].begin(),
                   [this](float c) { return binOf(c); });
  }
  return bins;
}

double ReliabilityTable::outlier(std::size_t confidence, const PixelTestimony& testimony) const {
  return table_[outcome(confidence, testimony)];
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
  JointCounts joint = noCounts();
  for (std::size_t k = 0; k < kOutcomes; ++k)
    joint.counts[joint.index(observations(outcomeAt(k)))] += counts[k];
  const TwoClassModel model = fitTwoClasses(joint, opinionOfTestimony());

  ReliabilityTable result;
  for (std::size_t k = 0; k < kOutcomes; ++k)
    result.table_.push_back(model.outlierGiven(observations(outcomeAt(k))));
  hearDenial(counts, result.table_);
  result.describe(counts);
  return result;
}

}  // namespace vdbfuse
