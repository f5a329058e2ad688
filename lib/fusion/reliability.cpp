// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/reliability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fusion/alternatives.h"
#include "fusion/denial.h"
#include "fusion/learn_reliability.h"
#include "fusion/missed_surfaces.h"
#include "fusion/pixel_testimony.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/domain.h"
#include "vdbfuse/fusion/no_return.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

std::vector<CompactSurface> analyseAll(const std::vector<View>& views, const NoiseLaw& noise,
                                       const Progress& progress) {
  std::vector<CompactSurface> surfaces;
  surfaces.reserve(views.size());
  ProgressStep step(progress, "analyse surfaces", views.size());
  forEachView(views, [&](const View& view) {
    surfaces.push_back(analyseCompactly(view, noise));
    letGo(surfaces.back());
    step.advance();
  });
  return surfaces;
}

void setOutliers(const Testimonies& testimonies, const std::vector<Image<std::uint8_t>>& confidence,
                 const ReliabilityTable& table, std::vector<JudgedView>& views) {
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    const Image<PixelTestimony>& said = testimonies.views[i];
    const std::uint8_t* bins = confidence[i].empty() ? nullptr : confidence[i].data();
    float* outlier = views[i].outlier.data();
    std::fill_n(outlier, said.size(), kMaxOutlier);
    forEachMeasured(said, [&](std::size_t p) {
      const float learned = table.outlier(bins == nullptr ? 0 : bins[p], said.data()[p]);
      outlier[p] = std::min(std::max(learned, kMinOutlier), kMaxOutlier);
    });
    letGo(views[i].outlier), letGo(said), letGo(confidence[i]);
  });
}

ReliabilityModel modelOf(const ReliabilityTable& table, const ConfidenceBins& bins) {
  return {table.outlierShare(), bins.ends(), table.byConfidence()};
}

// Empty space around an object shows as a no-return along most of the border of most images; a room does not.
bool trustNoReturn(std::vector<double> border_shares, JudgeOptions::NoReturn rule) {
  constexpr double kMostOfTheBorder = 0.5;
  if (rule != JudgeOptions::NoReturn::Auto) return rule == JudgeOptions::NoReturn::Free;
  const auto middle = border_shares.begin() + static_cast<std::ptrdiff_t>(border_shares.size() / 2);
  std::nth_element(border_shares.begin(), middle, border_shares.end());
  return *middle > kMostOfTheBorder;
}

void setLook(const Image<std::uint8_t>& empty, JudgedView& view) {
  std::transform(empty.begin(), empty.end(), view.look.begin(),
                 [](std::uint8_t is_empty) { return is_empty ? Look::Empty : Look::Nothing; });
}

// A view with a mask needs no guess: what is missing inside its silhouette is a hole in the measurements.
void setNoReturns(const std::vector<std::size_t>& unmasked, JudgeOptions::NoReturn rule,
                  std::vector<JudgedView>& views) {
  if (unmasked.empty()) return;
  std::vector<double> border_shares(unmasked.size());
  parallelFor(unmasked.size(), 1, [&](std::size_t k, std::size_t) {
    JudgedView& view = views[unmasked[k]];
    const Image<std::uint8_t> empty = emptyRegions(view.depth, view.outlier);
    border_shares[k] = borderShare(empty);
    setLook(empty, view);
    letGo(view);
  });
  if (trustNoReturn(std::move(border_shares), rule)) return;
  for (const std::size_t i : unmasked) {
    std::fill(views[i].look.begin(), views[i].look.end(), Look::Nothing);
    letGo(views[i]);
  }
}

// Takes back what was called empty where others measured a surface; all of it in views that missed so much.
void takeBackMissed(const std::vector<std::size_t>& order,
                    const std::vector<std::vector<std::size_t>>& neighbours,
                    const std::vector<Image<PixelTestimony>>& testimonies, const Box& domain,
                    std::vector<JudgedView>& views) {
  std::vector<PixelList> missed(views.size());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    missed[i] = missedPixels(views[i], testimonies[i]);
    letGo(views[i]), letGo(testimonies[i]);
  });
  const Neighbourhoods around{order, neighbours, windowBytes(views.front().memory()),
                              [&](std::size_t i) { return imageBytes(views[i]); },
                              [&](std::size_t i) { letGo(views[i]); }};
  forEachNeighbourhood(around, [&](std::size_t i) {
    constexpr double kMissesTooMuch = 0.2;  // of the surface that it might have met
    JudgedView& view = views[i];
    const auto before = std::count(view.look.begin(), view.look.end(), Look::Empty);
    if (before == 0) return;
    setLook(emptyRegions(view.depth, view.outlier, missedSurfaces(views, i, neighbours[i], missed, domain)),
            view);
    const auto taken_back = before - std::count(view.look.begin(), view.look.end(), Look::Empty);
    const auto without = std::count(view.depth.begin(), view.depth.end(), kInvalidDepth);
    const auto met = static_cast<std::ptrdiff_t>(view.depth.size()) - without;
    if (static_cast<double>(taken_back) > kMissesTooMuch * static_cast<double>(taken_back + met))
      std::fill(view.look.begin(), view.look.end(), Look::Nothing);
  });
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
  forEachView(views, [](View& view) { applyMask(view.map); });
  const ConfidenceBins bins(views);
  const std::vector<Image<std::uint8_t>> confidence = bins.replace(views);
  std::vector<std::vector<std::size_t>> neighbours = chooseNeighbours(graph, count, options.neighbours);
  std::vector<std::size_t> order = pathThrough(graph, count);
  const std::vector<std::vector<std::size_t>> around = neighbours;  // without alternatives
  const std::vector<std::size_t> path = order;
  const AlternativeViews alternatives(views);
  alternatives.extend(neighbours);
  for (std::size_t i = count; i < views.size(); ++i) order.push_back(i);
  std::vector<CompactSurface> surfaces = analyseAll(views, sensor.noise, progress);
  Testimonies testimonies =
      hearNeighbours(views, surfaces, sensor, neighbours, alternatives.of(), order, progress);
  for (CompactSurface& surface : surfaces) surface.normal = {}, surface.continuity = {};
  alternatives.restore(views);
  ReliabilityTable table = learnReliability(testimonies, confidence);

  const std::vector<std::size_t> unmasked = viewsWithoutMask(views);
  const std::vector<double> weights = redundancyWeights(graph, count);
  Judgement result;
  std::vector<Image<float>> incidence(count);
  for (std::size_t i = 0; i < count; ++i) incidence[i] = std::move(surfaces[i].incidence);
  JudgedViews& judged = result.judged = believe(std::move(views), sensor, kMinOutlier, std::move(incidence));
  judged.miss_rate = testimonies.miss_rate;
  for (std::size_t i = 0; i < count; ++i) judged.views[i].weight = weights[i];
  setOutliers(testimonies, confidence, table, judged.views);
  result.domain = options.domain ? *options.domain : supportedDomain(judged);
  widenRange(judged, result.domain);

  if (options.denial == JudgeOptions::Denial::Examine) {
    examineDenial(judged, result.domain, testimonies, progress);
    table = learnReliability(testimonies, confidence);
    setOutliers(testimonies, confidence, table, judged.views);
  }
  setNoReturns(unmasked, options.no_return, judged.views);
  if (options.no_return == JudgeOptions::NoReturn::Auto)
    takeBackMissed(path, around, testimonies.views, result.domain, judged.views);
  for (std::size_t i = 0; i < count; ++i) {
    weighAlternatives(alternatives, i, testimonies, confidence[i], table, surfaces, judged.views[i]);
    letGo(judged.views[i]), letGo(confidence[i]);
    for (const std::size_t layer : alternatives.of()[i])
      letGo(testimonies.views[layer]), letGo(surfaces[layer]);
  }
  result.model = modelOf(table, bins);
  return result;
}

}  // namespace vdbfuse
