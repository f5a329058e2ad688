// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/evidence.h"

#include <cmath>
#include <span>

#include "fusion/prepared_view.h"
#include "fusion/testimony_sum.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr double kMinMissRate = 0.2;
constexpr std::size_t kCellsPerTask = 1024;

double totalWeight(const JudgedViews& judged) {
  double sum = 0;
  for (const JudgedView& view : judged.views) sum += view.weight;
  return sum;
}

// Adds up all views' testimony at blocks of points.
class Combiner {
 public:
  Combiner(const JudgedViews& judged, const EvidenceOptions& options)
      : views_(prepare(judged)), sum_(judged.sensor, judged.miss_rate, options, totalWeight(judged)) {}

  // out[i] = evidence at points[i]; at most a block of them.
  void combine(std::span<const Eigen::Vector3d> points, float* out) const {
    const PointBlock block(points);
    std::vector<float> nodes(points.size() * sum_.nodeCount()), reports(points.size()), heard(points.size()),
        empties(points.size()), masked(points.size());
    const TestimonySums sums{nodes, reports, heard, empties, masked};
    for (const PreparedView& view : views_)
      sum_.add(view, block, static_cast<float>(view.view->weight), sums);
    sum_.finish(sums, out);
  }

 private:
  std::vector<PreparedView> views_;
  TestimonySum sum_;
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
  for (std::size_t first = 0; first < points.size(); first += PointBlock::kCapacity) {
    const std::size_t count = std::min(PointBlock::kCapacity, points.size() - first);
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
  if (!(options.thickness >= 0)) problems.emplace_back("thickness must not be negative");
  if (options.max_no_returns < 0) problems.emplace_back("max_no_returns must not be negative");
  if (!(options.mask_error > 0 && options.mask_error < 0.5))
    problems.emplace_back("mask_error must lie in (0, 0.5)");
  return problems;
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
