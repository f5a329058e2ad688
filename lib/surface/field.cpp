// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/field.h"

#include <cmath>
#include <numbers>

#include "surface/boundary.h"
#include "surface/completion.h"
#include "surface/fragments.h"
#include "surface/measure.h"
#include "surface/settle.h"
#include "surface/smooth.h"

namespace vdbfuse {
namespace {

constexpr float kCutOff = 2.0f;       // voxels: largest distance that is kept
constexpr float kClose = 1.25f;       // voxels: where the surface is measured once more
constexpr float kPutBack = 0.05f;     // voxels: what a voxel gets whose value has the wrong sign
constexpr std::size_t kFragment = 8;  // voxels: the completion leaves no smaller pieces
constexpr double kRounding = 1.0;     // voxels: width of the first smoothing, which the second look corrects

// The signed field while it is made. All arrays hold 512 values a block.
struct FieldParts {
  BlockField sides;
  std::vector<float> may_measure;  ///< 1 where the depth maps are asked
  MeasuredField measured;
  std::vector<float> completed;  ///< signed distance, kUnknown where nothing was completed
  float voxel() const { return static_cast<float>(sides.frame.voxel); }
};

std::vector<float> moved(const std::vector<float>& values, const BlockSet& from, const BlockSet& to,
                         float missing) {
  std::vector<float> result(to.valueCount(), missing);
  forEachBlock(to.count(), [&](std::size_t b) {
    const std::uint32_t old = from.find(to.origin(b));
    if (old != kNoBlock) std::copy_n(&values[old * kBlockSize], kBlockSize, &result[b * kBlockSize]);
  });
  return result;
}

FieldParts measureSides(const JudgedViews& judged, const LabelledCells& cells, const ScalarGrid& support,
                        float supported, const Progress& progress) {
  const CellLabel beyond = cells.energy.border == Border::Solid ? CellLabel::Inside : CellLabel::Outside;
  FieldParts parts{labelledSides(cells, beyond), {}, {}, {}};
  parts.may_measure = nearBoundary(parts.sides);
  keepSupported(parts.sides.blocks, support, supported, parts.may_measure);
  parts.measured = measureDistances(judged, parts.sides, parts.may_measure, progress);
  parts.completed.assign(parts.sides.values.size(), kUnknown);
  return parts;
}

// Moves the sides where nothing was measured.
CompletionReport complete(const LabelledCells& cells, const ScalarGrid& support, const FieldOptions& options,
                          const Progress& progress, FieldParts& parts) {
  const CellPyramid pyramid(cells.octree, cells.labels, cells.support, cells.sigma, cells.energy);
  const CompletionData data{support, options.supported, parts.sides.blocks, parts.measured.distance};
  const Completion completion = completeSurface(pyramid, cells.tiles, data, options.completion, progress);
  std::vector<Index3> blocks = parts.sides.blocks.origins();
  completion.appendBlocksTo(blocks);
  BlockField sides =
      grownSides(parts.sides.frame, std::move(blocks),
                 [&](const Index3& origin, float* values) { completion.readSides(origin, values); });
  parts.measured.distance = moved(parts.measured.distance, parts.sides.blocks, sides.blocks, kUnknown);
  parts.measured.weight = moved(parts.measured.weight, parts.sides.blocks, sides.blocks, 0.0f);
  parts.may_measure = moved(parts.may_measure, parts.sides.blocks, sides.blocks, 0.0f);
  parts.completed.resize(sides.values.size());
  forEachBlock(sides.blocks.count(), [&](std::size_t b) {
    completion.readDistances(sides.blocks.origin(b), &parts.completed[b * kBlockSize]);
  });
  parts.sides = std::move(sides);
  return completion.report();
}

// Measured, completed, or half a voxel from the boundary.
std::vector<float> firstField(const FieldParts& parts) {
  const std::vector<float> near = nearBoundary(parts.sides);
  const float limit = kCutOff * parts.voxel();
  std::vector<float> field(near.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    float value = parts.measured.distance[i];
    if (std::isnan(value)) value = parts.completed[i];
    if (std::isnan(value)) value = parts.sides.values[i] * (near[i] > 0 ? 0.5f * parts.voxel() : limit);
    field[i] = std::clamp(value, -limit, limit);
  }
  return field;
}

// 1 where the surface was completed.
std::vector<float> inventedVoxels(const FieldParts& parts) {
  std::vector<float> invented(parts.measured.distance.size());
  for (std::size_t i = 0; i < invented.size(); ++i)
    invented[i] = std::isnan(parts.measured.distance[i]) && !std::isnan(parts.completed[i]) ? 1.0f : 0.0f;
  return invented;
}

// A completed surface is smooth, but for the last fraction of a voxel.
void smoothInvented(const BlockSet& blocks, const std::vector<float>& invented, std::vector<float>& field) {
  const std::vector<float> smooth = smoothed(blocks, field, 1.0);
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (invented[i] > 0) field[i] = smooth[i];
  }
}

// Standard deviation, in voxels, of the Gaussian that smooths measurements of these weights as far as their
// noise asks for: over a surface it takes 4 π σ² voxels together, and what is left of an error e bends the
// surface by about e/(√(4 π) σ²).
double smoothingFor(std::vector<float> weights, double voxel, double most) {
  constexpr double kBendLeft = 0.1, kLeast = 0.5;  // radians; voxels
  std::erase(weights, 0.0f);
  if (weights.empty() || most <= kLeast) return most;
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2);
  std::nth_element(weights.begin(), middle, weights.end());
  const double error = 1 / (std::sqrt(*middle) * voxel);
  return std::clamp(std::sqrt(error / (kBendLeft * std::sqrt(4 * std::numbers::pi))), kLeast, most);
}

// A second look, at the surface that the first one gave: what smoothing and slanted rays have moved is put
// right, and only the difference is smoothed as far as the noise asks for.
void refine(const JudgedViews& judged, const FieldParts& parts, double smoothing, const Progress& progress,
            std::vector<float>& field) {
  std::vector<float> close(field.size());
  for (std::size_t i = 0; i < field.size(); ++i)
    close[i] = parts.may_measure[i] > 0 && std::abs(field[i]) < kClose * parts.voxel() ? 1.0f : 0.0f;
  BlockField current{parts.sides.frame, parts.sides.blocks, std::move(field)};
  const MeasuredField residual = measureResiduals(judged, close, current, progress);
  const std::vector<float> change =
      smoothed(parts.sides.blocks, residual.distance, smoothing, residual.weight);
  field = std::move(current.values);
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (close[i] > 0 && !std::isnan(change[i])) field[i] += change[i];
  }
}

ScalarGrid gridOf(const BlockField& field) {
  ScalarGrid grid("surface", field.frame, kUnknown, field.blocks.origins());
  grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    std::copy_n(field.block(field.blocks.find(leaf.origin)), kBlockSize, leaf.values.begin());
  });
  grid.setKind(GridKind::LevelSet);
  grid.metadata()["about"] = "signed distance to the surface, > 0 outside";
  return grid;
}

}  // namespace

SurfaceField signedField(const JudgedViews& judged, const LabelledCells& cells, const ScalarGrid& support,
                         const FieldOptions& options, const Progress& progress) {
  FieldParts parts = measureSides(judged, cells, support, options.supported, progress);
  std::optional<CompletionReport> report;
  if (options.completion.kind == CompletionOptions::Kind::Isotropic)
    report = complete(cells, support, options, progress, parts);
  const std::vector<float> invented = inventedVoxels(parts);
  if (report) dropFragments(invented, kFragment, parts.sides);
  std::vector<float> field = firstField(parts);
  std::vector<float> may_change = invented;
  for (std::size_t i = 0; i < may_change.size(); ++i) {
    if (!std::isnan(parts.measured.distance[i])) may_change[i] = 1;
  }
  const double smoothing = smoothingFor(parts.measured.weight, parts.voxel(), options.smoothing_voxels);
  parts.measured = {}, parts.completed = {};  // they are in the field
  if (smoothing > 0) {
    smoothInvented(parts.sides.blocks, invented, field);
    field = smoothed(parts.sides.blocks, field, std::max(kRounding, smoothing));
    refine(judged, parts, smoothing, progress, field);
  }
  settleSides(field, may_change, parts.sides);
  // Of pieces that were measured away settling leaves a voxel each.
  const std::size_t unresolved = dropUnresolved(options.least_width, parts.sides);
  putBack(parts.sides, kPutBack * parts.voxel(), field);
  return {gridOf({parts.sides.frame, parts.sides.blocks, std::move(field)}), report, unresolved};
}

}  // namespace vdbfuse
