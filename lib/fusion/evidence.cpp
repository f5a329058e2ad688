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

// Sums of many points over all views. Windows of views pass by on the outside, so that any number of views
// needs no more memory than one window of them.
class Combiner {
 public:
  Combiner(const JudgedViews& judged, const EvidenceOptions& options)
      : judged_(judged), sum_(judged.sensor, judged.miss_rate, options, totalWeight(judged)) {}

  // How many points may be summed up at a time.
  std::size_t capacity() const {
    constexpr std::size_t kBytes = std::size_t{256} << 20;
    return kBytes / (sizeof(float) * (sum_.nodeCount() + 5));
  }

  // Evidence of points that lie in tasks: points_of(task) are those at first[task] ... first[task + 1] − 1 of
  // the result.
  template <class PointsOf>
  std::vector<float> combine(const std::vector<std::size_t>& first, const PointsOf& points_of) const {
    const std::size_t tasks = first.size() - 1, count = first.back();
    std::vector<float> nodes(count * sum_.nodeCount()), reports(count), heard(count), empties(count),
        masked(count), values(count);
    const TestimonySums sums{nodes, reports, heard, empties, masked};
    forEachPrepared(judged_, [&](const std::vector<PreparedView>& views) {
      parallelFor(tasks, 1, [&](std::size_t task, std::size_t) {
        forEachBlock(points_of(task), [&](const PointBlock& block, std::size_t place) {
          const TestimonySums part = sums.part(first[task] + place, block.size);
          for (const PreparedView& view : views)
            sum_.add(view, block, static_cast<float>(view.view->weight), part);
        });
      });
    });
    parallelFor(tasks, 1, [&](std::size_t task, std::size_t) {
      for (std::size_t i = first[task]; i < first[task + 1]; i += PointBlock::kCapacity) {
        const std::size_t size = std::min(PointBlock::kCapacity, first[task + 1] - i);
        sum_.finish(sums.part(i, size), &values[i]);
      }
    });
    return values;
  }

 private:
  template <class Visit>
  static void forEachBlock(const std::vector<Eigen::Vector3d>& points, const Visit& visit) {
    for (std::size_t i = 0; i < points.size(); i += PointBlock::kCapacity) {
      const std::size_t size = std::min(PointBlock::kCapacity, points.size() - i);
      visit(PointBlock(std::span(points).subspan(i, size)), i);
    }
  }

  const JudgedViews& judged_;
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

std::size_t sampleCount(int level) {
  const auto side = static_cast<std::size_t>(samplesPerSide(level));
  return side * side * side;
}

// Cells that are evaluated together, in tasks of kCellsPerTask.
struct CellPass {
  std::vector<std::uint32_t> cells;
  std::vector<std::size_t> first{0};  // sample of each task, and the number of all
};

std::size_t taskEnd(const CellPass& pass, std::size_t task) {
  return std::min((task + 1) * kCellsPerTask, pass.cells.size());
}

// The cells that are not known yet.
std::vector<CellPass> passesOf(const Octree& octree, const CellEvidence& known, std::size_t capacity) {
  std::vector<CellPass> passes(1);
  std::size_t samples = 0;  // of the task that is being filled
  for (std::size_t c = 0; c < octree.cellCount(); ++c) {
    if (!std::isnan(known.mean[c])) continue;
    CellPass* pass = &passes.back();
    if (pass->cells.size() % kCellsPerTask == 0 && !pass->cells.empty()) {
      pass->first.push_back(pass->first.back() + samples);
      samples = 0;
      if (pass->first.back() >= capacity) pass = &passes.emplace_back();
    }
    pass->cells.push_back(static_cast<std::uint32_t>(c));
    samples += sampleCount(octree.levels[c]);
  }
  passes.back().first.push_back(passes.back().first.back() + samples);
  return passes;
}

void evaluate(const Combiner& combiner, const Octree& octree, const CellPass& pass, CellEvidence& evidence) {
  const std::vector<float> values = combiner.combine(pass.first, [&](std::size_t task) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = task * kCellsPerTask; i < taskEnd(pass, task); ++i)
      appendSamples(octree, pass.cells[i], points);
    return points;
  });
  const float* next = values.data();
  for (const std::uint32_t cell : pass.cells) {
    const std::size_t count = sampleCount(octree.levels[cell]);
    const auto [low, high] = std::minmax_element(next, next + count);
    evidence.weakest[cell] = *low > 0 ? *low : *high < 0 ? *high : 0.0f;
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += *next++;
    evidence.mean[cell] = static_cast<float>(sum / static_cast<double>(count));
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
  return Combiner(judged, options).combine({0, points.size()}, [&](std::size_t) { return points; });
}

void evaluateCells(const JudgedViews& judged, const Octree& octree, const EvidenceOptions& options,
                   CellEvidence& evidence, const Progress& progress) {
  requireValid(options);
  const Combiner combiner(judged, options);
  const std::vector<CellPass> passes = passesOf(octree, evidence, combiner.capacity());
  ProgressStep step(progress, "evidence", passes.size());
  for (const CellPass& pass : passes) {
    evaluate(combiner, octree, pass, evidence);
    step.advance();
  }
}

std::vector<float> evidence(const JudgedViews& judged, const Octree& octree, const EvidenceOptions& options,
                            const Progress& progress) {
  CellEvidence result(octree.cellCount());
  evaluateCells(judged, octree, options, result, progress);
  return std::move(result.mean);
}

}  // namespace vdbfuse
