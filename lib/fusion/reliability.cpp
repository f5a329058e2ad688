// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/reliability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fusion/alternatives.h"
#include "fusion/denial.h"
#include "fusion/learn_reliability.h"
#include "fusion/pixel_testimony.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/domain.h"
#include "vdbfuse/fusion/no_return.h"

namespace vdbfuse {
namespace {

std::vector<PixelSurface> analyseAll(const std::vector<View>& views, const NoiseLaw& noise,
                                     const Progress& progress) {
  std::vector<PixelSurface> surfaces(views.size());
  ProgressStep step(progress, "analyse surfaces", views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    surfaces[i] = analyseSurface(views[i], noise);
    step.advance();
  }
  return surfaces;
}

void setOutliers(const Testimonies& testimonies, const std::vector<Image<std::uint8_t>>& confidence,
                 const ReliabilityTable& table, std::vector<JudgedView>& views) {
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    const Image<PixelTestimony>& said = testimonies.views[i];
    for (std::size_t p = 0; p < said.size(); ++p) {
      const std::size_t c = confidence[i].empty() ? 0 : confidence[i].data()[p];
      const double outlier = said.data()[p].measured ? table.outlier(c, said.data()[p]) : kMaxOutlier;
      views[i].outlier.data()[p] = std::clamp(static_cast<float>(outlier), kMinOutlier, kMaxOutlier);
    }
  });
}

ReliabilityModel modelOf(const ReliabilityTable& table, const ConfidenceBins& bins) {
  return {table.outlierShare(), bins.ends(), table.byConfidence()};
}

// Empty space around an object shows as a no-return along most of the border of most images; a room does not.
bool trustNoReturn(const std::vector<Image<std::uint8_t>>& empty, JudgeOptions::NoReturn rule) {
  constexpr double kMostOfTheBorder = 0.5;
  if (rule != JudgeOptions::NoReturn::Auto) return rule == JudgeOptions::NoReturn::Free;
  std::vector<double> shares;
  for (const Image<std::uint8_t>& view : empty) shares.push_back(borderShare(view));
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  return *middle > kMostOfTheBorder;
}

// A view with a mask needs no guess: what is missing inside its silhouette is a hole in the measurements.
void setNoReturns(const std::vector<std::size_t>& unmasked, JudgeOptions::NoReturn rule,
                  std::vector<JudgedView>& views) {
  if (unmasked.empty()) return;
  std::vector<Image<std::uint8_t>> empty(unmasked.size());
  parallelFor(unmasked.size(), 1,
              [&](std::size_t k, std::size_t) { empty[k] = emptyRegions(views[unmasked[k]].depth); });
  if (!trustNoReturn(empty, rule)) return;
  for (std::size_t k = 0; k < unmasked.size(); ++k) {
    std::transform(empty[k].begin(), empty[k].end(), views[unmasked[k]].look.begin(),
                   [](std::uint8_t is_empty) { return is_empty ? Look::Empty : Look::Nothing; });
  }
}

std::vector<std::size_t> viewsWithoutMask(const std::vector<View>& views) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].map.mask.empty()) found.push_back(i);
  }
  return found;
}

}  // namespace

ConfidenceDirection confidenceDirection(const ReliabilityModel& model) {
  constexpr double kNoticeable = 0.02;
  if (model.confidence_bins.empty()) return ConfidenceDirection::None;
  const auto& curve = model.outlier_by_confidence;
  const std::ptrdiff_t half = static_cast<std::ptrdiff_t>(curve.size() / 2);
  const double low = std::accumulate(curve.begin(), curve.begin() + half, 0.0) / static_cast<double>(half);
  const double high = std::accumulate(curve.begin() + half, curve.end(), 0.0) / static_cast<double>(half);
  if (std::abs(low - high) < kNoticeable) return ConfidenceDirection::Uninformative;
  return high < low ? ConfidenceDirection::HighIsGood : ConfidenceDirection::HighIsBad;
}

Judgement judge(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                const JudgeOptions& options, const Progress& progress) {
  const std::size_t count = views.size();
  for (View& view : views) applyMask(view.map);
  const ConfidenceBins bins(views);
  const std::vector<Image<std::uint8_t>> confidence = bins.binAll(views);
  std::vector<std::vector<std::size_t>> neighbours = chooseNeighbours(graph, count, options.neighbours);
  const AlternativeViews alternatives(views);
  alternatives.extend(neighbours);
  std::vector<PixelSurface> surfaces = analyseAll(views, sensor.noise, progress);
  Testimonies testimonies = hearNeighbours(views, surfaces, sensor, neighbours, alternatives.of(), progress);
  alternatives.restore(views);
  ReliabilityTable table = learnReliability(testimonies, confidence);

  const std::vector<std::size_t> unmasked = viewsWithoutMask(views);

  Judgement result;
  JudgedViews& judged = result.judged = believe(std::move(views), sensor);
  judged.miss_rate = testimonies.miss_rate;
  const std::vector<double> weights = redundancyWeights(graph, count);
  for (std::size_t i = 0; i < count; ++i) {
    judged.views[i].incidence = std::move(surfaces[i].incidence);
    judged.views[i].weight = weights[i];
  }
  setNoReturns(unmasked, options.no_return, judged.views);
  setOutliers(testimonies, confidence, table, judged.views);
  result.domain = options.domain ? *options.domain : supportedDomain(judged);
  widenRange(judged, result.domain);

  if (options.denial == JudgeOptions::Denial::Examine) {
    examineDenial(judged, result.domain, testimonies, progress);
    table = learnReliability(testimonies, confidence);
    setOutliers(testimonies, confidence, table, judged.views);
  }
  for (std::size_t i = 0; i < count; ++i)
    weighAlternatives(alternatives, i, testimonies, confidence[i], table, surfaces, judged.views[i]);
  result.model = modelOf(table, bins);
  return result;
}

}  // namespace vdbfuse
