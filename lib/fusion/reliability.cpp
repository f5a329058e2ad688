// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/reliability.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fusion/two_class_em.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/no_return.h"
#include "vdbfuse/fusion/pixel_surface.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

using Model = ReliabilityModel;
constexpr std::uint8_t kNotMeasured = 255;
constexpr double kAgreeSigmas = 3.0;
constexpr double kAgreeCosine = 0.70710678;  // 45°

int continuityBin(float share) { return share < 0.4f ? 0 : share < 0.7f ? 1 : share < 0.9f ? 2 : 3; }

// Chances of confirmed points to be missed, counted along the way.
struct MissCounts {
  double missed = 0, looked = 0;
};

// Observations of one view: the cell of each pixel, kNotMeasured where there is no depth.
struct Observed {
  Image<std::uint8_t> cell;
  MissCounts misses;
};

class Observer {
 public:
  Observer(const std::vector<View>& views, const std::vector<PixelSurface>& surfaces,
           const SensorModel& sensor, const std::vector<std::vector<std::size_t>>& neighbours)
      : views_(views), surfaces_(surfaces), sensor_(sensor), neighbours_(neighbours) {}

  Observed observe(std::size_t index) const {
    const Image<float>& depth = views_[index].map.depth;
    Observed result{Image<std::uint8_t>(depth.width(), depth.height(), kNotMeasured), {}};
    std::vector<Projector> projectors;
    for (const std::size_t other : neighbours_[index]) {
      projectors.emplace_back(views_[other].projection, views_[other].world_from_camera);
    }
    for (int y = 0; y < depth.height(); ++y) {
      for (int x = 0; x < depth.width(); ++x) {
        if (depth(x, y) != kInvalidDepth)
          result.cell(x, y) = observePixel(index, x, y, projectors, result.misses);
      }
    }
    return result;
  }

 private:
  std::uint8_t observePixel(std::size_t index, int x, int y, const std::vector<Projector>& projectors,
                            MissCounts& misses) const {
    const Eigen::Vector3d point = worldPoint(views_[index], x, y);
    const double noise = sensor_.noise.at(views_[index].map.depth(x, y));
    const Eigen::Vector3f normal = surfaces_[index].normal(x, y);
    int agreeing = 0, missing = 0;
    for (std::size_t k = 0; k < projectors.size(); ++k) {
      const std::optional<Sighting> seen = projectors[k](point);
      if (!seen) continue;
      const std::size_t other = neighbours_[index][k];
      const float measured = views_[other].map.depth(seen->x, seen->y);
      missing += measured == kInvalidDepth;
      agreeing += agrees(other, *seen, measured, noise, normal);
    }
    if (agreeing >= 3) misses.missed += missing, misses.looked += missing + agreeing;
    const int continuity = continuityBin(surfaces_[index].continuity(x, y));
    return static_cast<std::uint8_t>(std::min(agreeing, Model::kAgreements - 1) * Model::kContinuities +
                                     continuity);
  }

  bool agrees(std::size_t other, const Sighting& seen, float measured, double noise,
              const Eigen::Vector3f& normal) const {
    if (measured == kInvalidDepth) return false;
    const double combined = std::hypot(noise, lookupNoise(sensor_, views_[other].projection, measured));
    if (std::abs(measured - seen.depth) > kAgreeSigmas * combined) return false;
    const Eigen::Vector3f other_normal = surfaces_[other].normal(seen.x, seen.y);
    if (normal.isZero() || other_normal.isZero()) return true;
    return normal.dot(other_normal) >= kAgreeCosine;
  }

  const std::vector<View>& views_;
  const std::vector<PixelSurface>& surfaces_;
  const SensorModel& sensor_;
  const std::vector<std::vector<std::size_t>>& neighbours_;
};

// Upper ends of quantile bins of all confidences that belong to a valid depth; empty when they do not vary.
std::vector<float> confidenceBins(const std::vector<View>& views) {
  constexpr std::size_t kStride = 7;  // a sample is enough for twenty quantiles
  std::vector<float> sample;
  for (const View& view : views) {
    if (view.map.confidence.empty()) return {};
    for (std::size_t i = 0; i < view.map.depth.size(); i += kStride) {
      const float c = view.map.confidence.data()[i];
      if (view.map.depth.data()[i] != kInvalidDepth && std::isfinite(c)) sample.push_back(c);
    }
  }
  if (sample.empty()) return {};
  std::sort(sample.begin(), sample.end());
  if (sample.front() == sample.back()) return {};
  std::vector<float> bins;
  for (int k = 1; k < Model::kConfidences; ++k)
    bins.push_back(sample[sample.size() * static_cast<std::size_t>(k) / Model::kConfidences]);
  return bins;
}

std::size_t confidenceBin(const std::vector<float>& bins, const Image<float>& confidence, int x, int y) {
  if (bins.empty()) return 0;
  const float c = confidence(x, y);
  if (!std::isfinite(c)) return 0;
  return static_cast<std::size_t>(std::upper_bound(bins.begin(), bins.end(), c) - bins.begin());
}

using Histogram = std::array<std::array<double, Model::kCells>, Model::kConfidences>;

Histogram countObservations(const std::vector<View>& views, const std::vector<Observed>& observed,
                            const std::vector<float>& bins) {
  Histogram counts{};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Image<std::uint8_t>& cells = observed[i].cell;
    for (int y = 0; y < cells.height(); ++y) {
      for (int x = 0; x < cells.width(); ++x) {
        if (cells(x, y) == kNotMeasured) continue;
        counts[confidenceBin(bins, views[i].map.confidence, x, y)][cells(x, y)] += 1;
      }
    }
  }
  return counts;
}

bool startsAsInlier(std::size_t agreement, std::size_t continuity) {
  return agreement >= 2 && continuity >= 2;
}

// Observations: confidence, and the cell of agreement and continuity.
TwoClassModel fitWithConfidence(const Histogram& counts) {
  JointCounts joint{Model::kConfidences, Model::kCells, {}};
  std::vector<double> outlier;
  for (const auto& row : counts) {
    for (std::size_t cell = 0; cell < Model::kCells; ++cell) {
      joint.counts.push_back(row[cell]);
      outlier.push_back(startsAsInlier(cell / Model::kContinuities, cell % Model::kContinuities) ? 0.0 : 1.0);
    }
  }
  return fitTwoClasses(joint, std::move(outlier));
}

// Observations: agreement, and continuity.
TwoClassModel fitWithoutConfidence(const Histogram& counts) {
  JointCounts joint{Model::kAgreements, Model::kContinuities, {}};
  std::vector<double> outlier;
  for (std::size_t cell = 0; cell < Model::kCells; ++cell) {
    joint.counts.push_back(counts[0][cell]);
    outlier.push_back(startsAsInlier(cell / Model::kContinuities, cell % Model::kContinuities) ? 0.0 : 1.0);
  }
  return fitTwoClasses(joint, std::move(outlier));
}

void summariseConfidence(const Histogram& counts, Model& model) {
  for (std::size_t c = 0; c < Model::kConfidences; ++c) {
    double all = 0, bad = 0;
    for (std::size_t cell = 0; cell < Model::kCells; ++cell) {
      all += counts[c][cell];
      bad += counts[c][cell] * model.outlier_given[c][cell];
    }
    model.outlier_by_confidence[c] = all > 0 ? bad / all : model.outlier_share;
  }
}

Model learn(const Histogram& counts, std::vector<float> bins) {
  Model model;
  const bool confident = !bins.empty();
  const TwoClassModel fit = confident ? fitWithConfidence(counts) : fitWithoutConfidence(counts);
  model.outlier_share = fit.outlier_share;
  for (std::size_t c = 0; c < Model::kConfidences; ++c) {
    for (std::size_t cell = 0; cell < Model::kCells; ++cell) {
      model.outlier_given[c][cell] =
          confident ? fit.outlierGiven(c, cell)
                    : fit.outlierGiven(cell / Model::kContinuities, cell % Model::kContinuities);
    }
  }
  model.confidence_bins = std::move(bins);
  summariseConfidence(counts, model);
  return model;
}

Image<float> outlierImage(const View& view, const Observed& observed, const Model& model) {
  Image<float> outlier(view.map.depth.width(), view.map.depth.height(), kMaxOutlier);
  for (int y = 0; y < outlier.height(); ++y) {
    for (int x = 0; x < outlier.width(); ++x) {
      const std::uint8_t cell = observed.cell(x, y);
      if (cell == kNotMeasured) continue;
      const std::size_t c = confidenceBin(model.confidence_bins, view.map.confidence, x, y);
      outlier(x, y) = std::clamp(static_cast<float>(model.outlier_given[c][cell]), kMinOutlier, kMaxOutlier);
    }
  }
  return outlier;
}

double missRate(const std::vector<Observed>& observed) {
  MissCounts sum;
  for (const Observed& o : observed) sum.missed += o.misses.missed, sum.looked += o.misses.looked;
  return sum.looked > 0 ? sum.missed / sum.looked : 0.5;
}

// Empty space around an object shows as a no-return along most of the border of most images; a room does not.
bool trustNoReturn(const std::vector<JudgedView>& views, JudgeOptions::NoReturn rule) {
  if (rule != JudgeOptions::NoReturn::Auto) return rule == JudgeOptions::NoReturn::Free;
  std::vector<double> shares;
  for (const JudgedView& view : views) shares.push_back(borderShare(view.no_return));
  std::nth_element(shares.begin(), shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2),
                   shares.end());
  return shares[shares.size() / 2] > 0.5;
}

std::vector<Observed> observeAll(const std::vector<View>& views, const std::vector<PixelSurface>& surfaces,
                                 const SensorModel& sensor, const ViewGraph& graph,
                                 const NeighbourOptions& options, const Progress& progress) {
  const auto neighbours = chooseNeighbours(graph, views.size(), options);
  const Observer observer(views, surfaces, sensor, neighbours);
  std::vector<Observed> observed(views.size());
  ProgressStep step(progress, "judge pixels", views.size());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    observed[i] = observer.observe(i);
    step.advance();
  });
  return observed;
}

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

}  // namespace

ConfidenceDirection confidenceDirection(const ReliabilityModel& model) {
  if (model.confidence_bins.empty()) return ConfidenceDirection::None;
  const auto& curve = model.outlier_by_confidence;
  const auto middle = curve.begin() + Model::kConfidences / 2;
  const double low = std::accumulate(curve.begin(), middle, 0.0) / (Model::kConfidences / 2);
  const double high = std::accumulate(middle, curve.end(), 0.0) / (Model::kConfidences / 2);
  if (std::abs(low - high) < 0.02) return ConfidenceDirection::Uninformative;
  return high < low ? ConfidenceDirection::HighIsGood : ConfidenceDirection::HighIsBad;
}

Judgement judge(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                const JudgeOptions& options, const Progress& progress) {
  std::vector<PixelSurface> surfaces = analyseAll(views, sensor.noise, progress);
  const std::vector<Observed> observed =
      observeAll(views, surfaces, sensor, graph, options.neighbours, progress);
  std::vector<float> bins = confidenceBins(views);
  const Histogram counts = countObservations(views, observed, bins);

  Judgement result;
  result.model = learn(counts, std::move(bins));
  std::vector<Image<float>> outliers(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    outliers[i] = outlierImage(views[i], observed[i], result.model);
  result.judged = believe(std::move(views), sensor);
  result.judged.miss_rate = missRate(observed);
  const std::vector<double> weights = redundancyWeights(graph, outliers.size());
  for (std::size_t i = 0; i < outliers.size(); ++i) {
    JudgedView& view = result.judged.views[i];
    view.outlier = std::move(outliers[i]);
    view.incidence = std::move(surfaces[i].incidence);
    view.no_return = emptyRegions(view.depth);
    view.weight = weights[i];
  }
  if (!trustNoReturn(result.judged.views, options.no_return)) {
    for (JudgedView& view : result.judged.views) std::fill(view.no_return.begin(), view.no_return.end(), 0);
  }
  return result;
}

}  // namespace vdbfuse
