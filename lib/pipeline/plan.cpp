// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/steps.h"
#include "pipeline/survey.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/memory.h"

namespace vdbfuse {
namespace {

constexpr double kMiB = 1 << 20;
constexpr double kShareOfFree = 0.8;

// Measured with the tool, release build: tests/benchmark/resolutions.py.
constexpr double kProcess = 60 * kMiB;         // code, tables, the images of a few views in the works
constexpr double kJudgedBytesPerPixel = 16.0;  // while views are judged: the list is in reliability.cpp
constexpr double kJudging = 250 * kMiB;        // beside the views: the grid of denial, points of the domain
constexpr double kKeptBytesPerPixel = 13.0;    // depth, ε, incidence, look
constexpr double kPass = 260 * kMiB;           // sums of the evidence
constexpr double kBytesPerCell = 160.0;        // when the surface is made
constexpr double kBytesPerCellOfEvidence = 45.0;
constexpr double kBytesPerVoxelOfTsdf = 30.0;  // when the rim is made
// Coarser cells beside the finest ones.
constexpr double kCellsPerFinest = 1.15;
// A neighbourhood of views must fit: one and those that judge it.
constexpr double kLeastViews = 12;

double pixelsOf(const ViewHeader& header, int factor) {
  return static_cast<double>(imageWidth(header.projection) / factor) *
         static_cast<double>(imageHeight(header.projection) / factor);
}

struct Pixels {
  double all = 0, largest = 0;
};

Pixels countPixels(const ViewSequence& views, const std::vector<int>& reduction) {
  Pixels pixels;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double count = pixelsOf(views.header(i), reduction[i]);
    pixels.all += count;
    pixels.largest = std::max(pixels.largest, count);
  }
  return pixels;
}

// Voxels of the leaves that a truncated distance touches. Where doubtful pixels are believed, too, strays
// fill leaves of their own, eight or so each, until all of the domain is full.
double expectedTsdfVoxels(const Survey& survey, double voxel, double pixels, const TsdfMethod& method) {
  constexpr double kLeafSide = 8, kLeavesPerStray = 8;
  const double truncation =
      method.truncation > 0 ? method.truncation : std::max(4 * voxel, 3 * survey.noise_scale);
  const double volume = survey.domain.volume() / std::pow(voxel, 3);
  const double surface = survey.area * (2 * truncation + kLeafSide * voxel) / std::pow(voxel, 3);
  const double leaves = volume / std::pow(kLeafSide, 3);
  const double strays = method.weights.confidence ? 0.0 : survey.stray_share * pixels;
  const double touched = leaves * -std::expm1(-kLeavesPerStray * strays / leaves);
  return std::min(surface + touched * std::pow(kLeafSide, 3), volume);
}

// Finest cells: the ridge of the support, two voxels around, and what rounding to pairs of voxels costs.
double expectedCells(const Survey& survey, double voxel, double pixels, const ReconstructOptions& options) {
  if (options.method == Method::Tsdf) return expectedTsdfVoxels(survey, voxel, pixels, options.tsdf);
  constexpr double kRidge = 0.83, kSupported = 1.6, kAround = 5.5;
  const double half_width = voxel < survey.noise_scale ? kRidge * survey.noise_scale : kSupported * voxel;
  const double layers = 2 * half_width / voxel + kAround;
  const double volume = survey.domain.volume() / std::pow(voxel, 3);
  return kCellsPerFinest * std::min(survey.area / (voxel * voxel) * layers, volume);
}

// Bytes beside the views while cells are worked on.
double gridBytes(double cells, Method method) {
  if (method == Method::Tsdf) return kBytesPerVoxelOfTsdf * cells;
  const double samples = 4 * cells;  // eight in a coarser cell
  return std::max(kBytesPerCell * cells, kBytesPerCellOfEvidence * cells + std::min(kPass, 64 * samples));
}

std::size_t budgetOf(const ReconstructOptions& options) {
  if (options.memory > 0) return options.memory;
  return static_cast<std::size_t>(kShareOfFree * static_cast<double>(availableMemoryBytes()));
}

// Memory at the peak, and how views are kept, when the cells need `grid` bytes. Nothing when it does not fit.
bool decideMemory(const Pixels& pixels, double grid, ScanPlan& plan) {
  const auto budget = static_cast<double>(plan.memory_budget);
  const double in_memory =
      kProcess + std::max(kJudgedBytesPerPixel * pixels.all, kKeptBytesPerPixel * pixels.all + grid);
  plan.window_bytes = 0;
  plan.estimated_memory = static_cast<std::size_t>(in_memory);
  if (in_memory <= budget) return true;
  // All that the cells leave is for views.
  const double least = kLeastViews * kJudgedBytesPerPixel * pixels.largest;
  const double fixed = kProcess + std::max(grid, kJudging + 64 * pixels.largest);
  const double window = std::min(budget - fixed, kJudgedBytesPerPixel * pixels.all / 2);
  plan.window_bytes = static_cast<std::size_t>(std::max(window, least));
  plan.estimated_memory = static_cast<std::size_t>(fixed) + plan.window_bytes;
  return window >= least;
}

// The smallest voxel that fits, rounded up to two digits; 0 when none does.
double fittingVoxel(const ViewSequence& views, const ReconstructOptions& options, ScanPlan plan) {
  const Pixels pixels = countPixels(views, plan.reduction);
  const auto fits = [&](double voxel) {
    return decideMemory(
        pixels, gridBytes(expectedCells(*plan.survey, voxel, pixels.all, options), options.method), plan);
  };
  double low = plan.voxel, high = plan.survey->domain.sizes().maxCoeff();
  if (!fits(high)) return 0;
  for (int i = 0; i < 60; ++i) (fits(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  const double digit = std::pow(10.0, std::floor(std::log10(high)) - 1);
  return std::ceil(high / digit) * digit;
}

std::vector<int> reductions(const ViewSequence& views, const Survey& survey, double voxel) {
  constexpr double kFinerThan = 0.5;  // voxels
  std::vector<int> factors;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double pixel = footprint(views.header(i).projection, survey.median_depth);
    factors.push_back(std::max(1, static_cast<int>(kFinerThan * voxel / pixel)));
  }
  return factors;
}

}  // namespace

ScanPlan planJudging(const ViewSequence& views, const ReconstructOptions& options) {
  requireUsable(views, options);
  ScanPlan plan;
  plan.memory_budget = budgetOf(options);
  plan.reduction.assign(views.size(), 1);
  const Pixels pixels = countPixels(views, plan.reduction);
  if (!decideMemory(pixels, 0, plan)) {
    throw InvalidArgument("memory", "judging needs " + sizeText(plan.estimated_memory) +
                                        " for a few views at a time, " + sizeText(plan.memory_budget) +
                                        " may be used");
  }
  return plan;
}

ScanPlan planReconstruction(const ViewSequence& views, const ReconstructOptions& options,
                            const Progress& progress) {
  requireUsable(views, options);
  StepTimer timer;
  timer.start("plan");
  std::optional<Survey> found = surveyScan(views, options, progress);
  ScanPlan plan = found ? ScanPlan() : planJudging(views, options);
  plan.steps = timer.finish();
  if (!found) return plan;
  plan.memory_budget = budgetOf(options);
  plan.reduction.assign(views.size(), 1);
  plan.survey = std::move(found);
  const Survey& survey = *plan.survey;
  CalibrationReport expected;
  expected.noise_scale = survey.noise_scale, expected.point_spacing = survey.point_spacing;
  plan.voxel = chooseFrame(survey.domain, expected, options).voxel;
  if (options.voxel > 0 || options.resolution > 0) plan.reduction = reductions(views, survey, plan.voxel);
  const Pixels pixels = countPixels(views, plan.reduction);
  plan.cells = expectedCells(survey, plan.voxel, pixels.all, options);
  if (decideMemory(pixels, gridBytes(plan.cells, options.method), plan)) return plan;
  const double fitting = fittingVoxel(views, options, plan);
  char voxels[64];
  std::snprintf(voxels, sizeof voxels, "%.4g needs about ", plan.voxel);
  char advice[64];
  std::snprintf(advice, sizeof advice, "; %.4g would fit", fitting);
  throw InvalidArgument(
      "voxel", voxels + sizeText(plan.estimated_memory) + " of memory, " + sizeText(plan.memory_budget) +
                   " may be used" +
                   (fitting > 0 ? advice : "; not even a few views at a time fit into that"));
}

}  // namespace vdbfuse
