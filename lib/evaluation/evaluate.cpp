// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "overlap.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mesh/closest_point.h"
#include "vdbfuse/mesh/sampling.h"
#include "vdbfuse/mesh/winding_number.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kGrain = 1024;

// From seeded samples of one surface to the other.
std::vector<double> distances(const TriangleMesh& from, const ClosestPoint& closest,
                              const EvaluateOptions& options) {
  const std::vector<SurfaceSample> samples = sampleSurface(from, options.samples, options.seed);
  std::vector<double> result(samples.size());
  parallelFor(samples.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) result[i] = closest.query(samples[i].point).distance;
  });
  return result;
}

double shareWithin(const std::vector<double>& values, double tau) {
  if (values.empty()) return 0;
  const auto within = std::count_if(values.begin(), values.end(), [tau](double d) { return d <= tau; });
  return static_cast<double>(within) / static_cast<double>(values.size());
}

double quantile90(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.9 * static_cast<double>(values.size()))) - 1;
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

double rootMeanSquare(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

ScoreAtTau scoreAt(double tau, const std::vector<double>& mesh_to_truth,
                   const std::vector<double>& truth_to_mesh) {
  const double precision = shareWithin(mesh_to_truth, tau), recall = shareWithin(truth_to_mesh, tau);
  const double sum = precision + recall;
  return {tau, precision, recall, sum > 0 ? 2 * precision * recall / sum : 0.0};
}

RegionShare shareOf(const Region& region, const WindingNumber& mesh, const WindingNumber& truth,
                    const EvaluateOptions& options) {
  const bool expected = region.expect == Expectation::Inside;
  const std::vector<Eigen::Vector3d> points =
      sampleRegion(region.shape, options.region_samples, options.seed);
  struct Count {
    std::size_t counted = 0, right = 0;
  };
  std::vector<Count> counts(chunkCount(points.size(), kGrain));
  parallelFor(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    Count& count = counts[begin / kGrain];
    for (std::size_t i = begin; i < end; ++i) {
      if (truth.inside(points[i]) != expected) continue;
      ++count.counted;
      count.right += mesh.inside(points[i]) == expected;
    }
  });
  Count total;
  for (const Count& count : counts) {
    total.counted += count.counted;
    total.right += count.right;
  }
  RegionShare share{region.name, region.expect, std::nullopt};
  if (total.counted > 0) share.share = static_cast<double>(total.right) / static_cast<double>(total.counted);
  return share;
}

// The winding number of a closed mesh jumps at its surface, so that a rough one is enough; that of an open
// mesh goes through one half gently.
WindingNumberOptions accuracyFor(bool closed) { return {.accuracy = closed ? 2.0 : 4.0}; }

void requireValid(const EvaluateOptions& options) {
  std::string all;
  for (const std::string& problem : validate(options)) all += (all.empty() ? "" : "; ") + problem;
  if (!all.empty()) throw InvalidArgument("options", all);
}

}  // namespace

std::vector<std::string> validate(const EvaluateOptions& options) {
  std::vector<std::string> problems;
  for (const double tau : options.taus) {
    if (!(tau > 0) || !std::isfinite(tau))
      problems.push_back("taus must be positive, found " + std::to_string(tau));
  }
  if (options.deep && (!(*options.deep >= 0) || !std::isfinite(*options.deep))) {
    problems.push_back("deep must not be negative, found " + std::to_string(*options.deep));
  }
  if (options.samples == 0) problems.push_back("samples must be positive");
  if (options.region_samples == 0) problems.push_back("region_samples must be positive");
  if (options.iou_resolution < 1 || options.iou_resolution > 2048) {
    problems.push_back("iou_resolution must be in 1 … 2048, found " + std::to_string(options.iou_resolution));
  }
  return problems;
}

Evaluation evaluate(const TriangleMesh& mesh, const TriangleMesh& truth, const EvaluateOptions& options,
                    const std::vector<Region>& regions) {
  requireValid(options);
  const TopologyReport truth_topology = topology(truth);
  Evaluation result{};
  result.topology = topology(mesh);

  const ClosestPoint mesh_surface(mesh), truth_surface(truth);
  const std::vector<double> truth_to_mesh = distances(truth, mesh_surface, options);
  if (truth_to_mesh.empty()) throw InvalidArgument("truth", "has no triangle with an area");
  const std::vector<double> mesh_to_truth = distances(mesh, truth_surface, options);
  const Box mesh_box = finiteBox(mesh), truth_box = finiteBox(truth);
  std::vector<double> taus = options.taus;
  if (taus.empty()) taus.push_back(0.01 * truth_box.diagonal().norm());
  for (const double tau : taus) result.scores.push_back(scoreAt(tau, mesh_to_truth, truth_to_mesh));
  result.accuracy90 = quantile90(mesh_to_truth);
  result.accuracy_rms = rootMeanSquare(mesh_to_truth);
  result.completeness = result.scores.front().recall;

  const bool mesh_closed = isClosedManifold(result.topology), truth_closed = isClosedManifold(truth_topology);
  const WindingNumber mesh_inside(mesh, accuracyFor(mesh_closed)),
      truth_inside(truth, accuracyFor(truth_closed));
  const Solid solid_mesh{mesh_inside, mesh_surface, mesh_box, mesh_closed};
  const Solid solid_truth{truth_inside, truth_surface, truth_box, truth_closed};
  const OverlapOptions overlap_options{options.iou_resolution, options.seed, options.deep};
  const Overlap volumes = overlap(solid_mesh, solid_truth, overlap_options);
  result.iou = volumes.iou;
  result.false_outside_deep = volumes.false_outside_deep;
  result.false_inside_deep = volumes.false_inside_deep;
  for (const Region& region : regions) {
    result.regions.push_back(shareOf(region, mesh_inside, truth_inside, options));
  }
  return result;
}

}  // namespace vdbfuse
