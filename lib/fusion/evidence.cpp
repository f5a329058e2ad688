// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/evidence.h"

#include <cmath>
#include <span>

#include "fusion/likelihood_ratio.h"
#include "fusion/prepared_view.h"
#include "fusion/visibility_integral.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr double kMinMissRate = 0.2;
// The first view's worth of masks counts no more than a no-return at its best (L = 3): against two views or
// more that deny a point that is not enough, so that one wrong mask, or any number of copies of it, cannot
// carve alone.
constexpr float kUnconfirmedMasks = 1.0f, kUnconfirmedMask = 1.0986123f;
// Points that one thread works on at a time: their sums stay in the cache.
constexpr std::size_t kBlock = 512;
constexpr std::size_t kCellsPerTask = 1024;

double totalWeight(const JudgedViews& judged) {
  double sum = 0;
  for (const JudgedView& view : judged.views) sum += view.weight;
  return sum;
}

// Adds up all views' testimony at a block of points, for one rule.
class Combiner {
 public:
  Combiner(const JudgedViews& judged, const EvidenceOptions& options)
      : options_(options),
        sensor_(judged.sensor),
        views_(prepare(judged)),
        ratio_(judged.sensor),
        integral_(options.visibility_prior, options.rule == EvidenceRule::Outside ? options.visibility : 1.0,
                  totalWeight(judged)),
        no_return_(static_cast<float>(logNoReturnRatio(judged.miss_rate))),
        mask_(static_cast<float>(logMaskRatio(options.mask_error))) {}

  // out[i] = evidence at points[i]; at most kBlock points.
  void combine(std::span<const Eigen::Vector3d> points, float* out) const {
    if (options_.rule == EvidenceRule::Constant) {
      std::fill_n(out, points.size(), static_cast<float>(-options_.balloon));
    } else if (options_.rule == EvidenceRule::Paper) {
      combinePaper(points, out);
    } else {
      combineOutside(points, out);
    }
  }

 private:
  // Weights that rays which met nothing may still throw in at a point.
  struct Free {
    float no_returns, unconfirmed_masks = kUnconfirmedMasks;
  };

  void addNoReturn(float weight, Free& left, float* sums) const {
    if (left.no_returns <= 0) return;
    integral_.add(no_return_, std::min(weight, left.no_returns), sums);
    left.no_returns -= weight;
  }

  // Only the sum of the weights matters, not the order of the views.
  void addMask(float weight, Free& left, float* sums) const {
    const float unconfirmed = std::min(weight, left.unconfirmed_masks);
    integral_.add(std::min(mask_, kUnconfirmedMask), unconfirmed, sums);
    if (weight > unconfirmed) integral_.add(mask_, weight - unconfirmed, sums);
    left.unconfirmed_masks -= unconfirmed;
  }

  void combineOutside(std::span<const Eigen::Vector3d> points, float* out) const {
    const std::size_t nodes = static_cast<std::size_t>(integral_.nodeCount());
    std::vector<float> sums(points.size() * nodes, 0.0f), reports(points.size(), 0.0f);
    std::vector<Free> free(points.size(), {static_cast<float>(options_.max_no_returns)});
    for (const PreparedView& prepared : views_) {
      const JudgedView& view = *prepared.view;
      const float weight = static_cast<float>(view.weight);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::optional<Sighting> seen = prepared.projector(points[i]);
        if (!seen) continue;
        const float measured = view.depth(seen->x, seen->y);
        const Look look = view.look(seen->x, seen->y);
        if (look == Look::Outside) {
          addMask(weight, free[i], &sums[i * nodes]);
        } else if (measured != kInvalidDepth) {
          integral_.add(logRatio(prepared, *seen, measured), weight, &sums[i * nodes]);
          reports[i] += weight;
        } else if (look == Look::Empty) {
          addNoReturn(weight, free[i], &sums[i * nodes]);
        }
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = static_cast<float>(prior(reports[i]) + integral_.logMean(&sums[i * nodes]));
    }
  }

  // π = t/(t + (1 − t) L): the probability that the sensor does not see past the point.
  void combinePaper(std::span<const Eigen::Vector3d> points, float* out) const {
    std::vector<double> log_hidden(points.size(), 0.0);
    std::vector<bool> reported(points.size(), false);
    for (const PreparedView& prepared : views_) {
      for (std::size_t i = 0; i < points.size(); ++i) {
        const std::optional<Sighting> seen = prepared.projector(points[i]);
        if (!seen) continue;
        const float measured = prepared.view->depth(seen->x, seen->y);
        const bool masked = prepared.view->look(seen->x, seen->y) == Look::Outside;
        if (measured == kInvalidDepth && !masked) continue;
        const double t =
            std::clamp((seen->depth - sensor_.near) / (sensor_.far - sensor_.near), 0.001, 0.999);
        const double odds = std::log((1 - t) / t) + (masked ? mask_ : logRatio(prepared, *seen, measured));
        log_hidden[i] -= odds > 30 ? odds : std::log1p(std::exp(odds));
        reported[i] = true;
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = reported[i] ? static_cast<float>(std::log(-std::expm1(log_hidden[i])) - log_hidden[i])
                           : static_cast<float>(options_.prior);
    }
  }

  float logRatio(const PreparedView& prepared, const Sighting& seen, float measured) const {
    return ratio_.log(measured, prepared.noise.at(measured), prepared.view->outlier(seen.x, seen.y),
                      static_cast<float>(seen.depth));
  }

  double prior(double reports) const {
    if (options_.rule == EvidenceRule::NoSelfOcclusion) return 0.0;
    return std::min(options_.prior, integral_.halfDenial(reports));
  }

  EvidenceOptions options_;
  SensorModel sensor_;
  std::vector<PreparedView> views_;
  LikelihoodRatio ratio_;
  VisibilityIntegral integral_;
  float no_return_, mask_;
};

// Samples a side of a cell: one in the middle of a finest cell.
int samplesPerSide(int level) { return level == 0 ? 1 : level <= 2 ? 2 : 4; }

void appendSamples(const Octree& octree, std::size_t cell, std::vector<Eigen::Vector3d>& points) {
  const int samples = samplesPerSide(octree.levels[cell]);
  const double step = static_cast<double>(octree.side(cell)) / samples;
  const Eigen::Vector3d first = octree.lowest(cell).cast<double>().array() + (0.5 * step - 0.5);
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      for (int k = 0; k < samples; ++k) {
        points.push_back(octree.frame.toWorld(Eigen::Vector3d(first + step * Eigen::Vector3d(i, j, k))));
      }
    }
  }
}

std::vector<float> combineAll(const Combiner& combiner, std::span<const Eigen::Vector3d> points) {
  std::vector<float> values(points.size());
  for (std::size_t first = 0; first < points.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, points.size() - first);
    combiner.combine(points.subspan(first, count), values.data() + first);
  }
  return values;
}

void evaluateCells(const Combiner& combiner, const Octree& octree, std::size_t begin, std::size_t end,
                   std::vector<float>& sigma) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t cell = begin; cell < end; ++cell) appendSamples(octree, cell, points);
  const std::vector<float> values = combineAll(combiner, points);
  const float* next = values.data();
  for (std::size_t cell = begin; cell < end; ++cell) {
    const int samples = samplesPerSide(octree.levels[cell]), count = samples * samples * samples;
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += *next++;
    sigma[cell] = static_cast<float>(sum / count);
  }
}

void requireValid(const EvidenceOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
}

}  // namespace

std::vector<std::string> validate(const EvidenceOptions& options) {
  std::vector<std::string> problems;
  if (!(options.visibility_prior > 0)) problems.emplace_back("visibility_prior must be positive");
  if (!(options.visibility >= 0 && options.visibility <= 1))
    problems.emplace_back("visibility must lie in [0, 1]");
  if (!std::isfinite(options.prior)) problems.emplace_back("prior must be finite");
  if (!(options.balloon >= 0)) problems.emplace_back("balloon must not be negative");
  if (options.max_no_returns < 0) problems.emplace_back("max_no_returns must not be negative");
  if (!(options.mask_error > 0 && options.mask_error < 0.5))
    problems.emplace_back("mask_error must lie in (0, 0.5)");
  return problems;
}

double logLikelihoodRatio(const SensorModel& sensor, double measured, double noise, double outlier,
                          double depth) {
  const double t = std::clamp((depth - sensor.near) / (sensor.far - sensor.near), 0.001, 0.999);
  const auto cdf = [&](double at) { return noiseCdf(sensor.shape, (at - measured) / noise); };
  const double a =
      ((1 - outlier) * std::max(cdf(sensor.far) - cdf(depth), 0.0) + outlier * (1 - t)) / (1 - t);
  const double b = ((1 - outlier) * std::max(cdf(depth) - cdf(sensor.near), 0.0) + outlier * t) / t;
  return std::log(a / b);
}

double logNoReturnRatio(double miss_rate) {
  constexpr double kSeenPast = 0.5;
  const double m = std::clamp(miss_rate, kMinMissRate, 1.0);
  return std::log((kSeenPast + (1 - kSeenPast) * m) / m);
}

double logMaskRatio(double mask_error) {
  constexpr double kPastEverything = 0.5;
  return std::log((kPastEverything * (1 - mask_error) + (1 - kPastEverything) * mask_error) / mask_error);
}

std::vector<float> evidenceAt(const JudgedViews& judged, const std::vector<Eigen::Vector3d>& points,
                              const EvidenceOptions& options) {
  requireValid(options);
  return combineAll(Combiner(judged, options), points);
}

std::vector<float> evidence(const JudgedViews& judged, const Octree& octree, const EvidenceOptions& options,
                            const Progress& progress) {
  requireValid(options);
  const Combiner combiner(judged, options);
  std::vector<float> sigma(octree.cellCount());
  ProgressStep step(progress, "evidence", octree.cellCount());
  parallelFor(octree.cellCount(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    evaluateCells(combiner, octree, begin, end, sigma);
    step.advance(end - begin);
  });
  return sigma;
}

}  // namespace vdbfuse
