// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "surface/completion.h"
#include "surface/label_blocks.h"
#include "surface/measure.h"
#include "surface/settle.h"
#include "surface/smooth.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kSize = BlockSet::kBlockSize;
constexpr int kReach = 4;           // voxels around the boundary that are looked at
constexpr double kCutOff = 2.0;     // voxels: largest distance that is kept
constexpr float kPutBack = 0.05f;   // voxels: what a voxel gets whose value has the wrong sign
constexpr std::size_t kBlocksPerTask = 16;

double env(const char* n, double d) { return getenv(n) ? atof(getenv(n)) : d; }

template <class Visit>
void forEachBlock(const BlockSet& blocks, const Visit& visit) {
  parallelFor(blocks.count(), kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) visit(b);
  });
}

// +1 (outside) and −1 (inside) on all blocks around the boundary.
BlockField labelSides(const LabelledCells& cells, CellLabel beyond) {
  BlockField sides{cells.octree.frame,
                   BlockSet(boundaryBlocks(cells.octree, cells.tiles, cells.labels, beyond, kReach)),
                   {}};
  sides.values.resize(sides.blocks.count() * kSize);
  const LabelReader reader(cells.octree, cells.labels, beyond);
  forEachBlock(sides.blocks, [&](std::size_t b) {
    std::array<CellLabel, kSize> labels;
    reader.readBlock(sides.blocks.origin(b), labels.data());
    std::transform(labels.begin(), labels.end(), sides.block(b),
                   [](CellLabel l) { return l == CellLabel::Outside ? 1.0f : -1.0f; });
  });
  return sides;
}

// Voxels with another side within two voxels along every axis.
std::vector<float> nearBoundary(const BlockField& sides) {
  std::vector<float> near(sides.values.size());
  // Both sides are among a voxel's neighbours when their mean is neither +1 nor −1.
  const std::vector<float> ones(sides.values.size(), 1.0f);
  const std::vector<float> mean = smoothed(sides.blocks, sides.values, ones, 2.0);
  for (std::size_t i = 0; i < near.size(); ++i) near[i] = std::abs(mean[i]) < 0.9999f ? 1.0f : 0.0f;
  return near;
}

// Clears `marks` where neither the voxel nor one of its six neighbours is supported.
void keepSupported(const BlockSet& blocks, const ScalarGrid& support, float supported,
                   std::vector<float>& marks) {
  std::vector<float> agreement(marks.size(), support.background());
  forEachBlock(blocks, [&](std::size_t b) {
    if (const std::optional<std::size_t> leaf = support.findLeaf(blocks.origin(b))) {
      const ScalarGrid::Leaf values = support.leaf(*leaf);
      std::copy(values.values.begin(), values.values.end(), &agreement[b * kSize]);
    }
  });
  forEachBlock(blocks, [&](std::size_t b) {
    PaddedBlock<1, 1> c;
    loadPadded(blocks, agreement.data(), b, support.background(), c);
    for (int i = 0; i < static_cast<int>(kSize); ++i) {
      const Index3 v = leafOffset(i);
      float largest = c.at(v.x(), v.y(), v.z());
      for (int n = 0; n < 6; ++n) {
        const Index3 o = v + (n % 2 * 2 - 1) * Index3(Index3::Unit(n / 2));
        largest = std::max(largest, c.at(o.x(), o.y(), o.z()));
      }
      if (!(largest >= supported)) marks[b * kSize + static_cast<std::size_t>(i)] = 0;
    }
  });
}

// Blocks around the boundary seen in a block that are not there.
void appendMissing(const BlockField& sides, std::size_t b, std::vector<Index3>& out) {
  constexpr int kMargin = 3;  // smoothing looks that far
  PaddedBlock<1, 1> near;
  loadPadded(sides.blocks, sides.values.data(), b, 0.0f, near);
  Index3 low = Index3::Constant(8), high = Index3::Constant(-1);
  for (int i = 0; i < static_cast<int>(kSize); ++i) {
    const Index3 v = leafOffset(i);
    const float side = near.at(v.x(), v.y(), v.z());
    for (int n = 0; n < 6; ++n) {
      const Index3 o = v + (n % 2 * 2 - 1) * Index3(Index3::Unit(n / 2));
      if (near.at(o.x(), o.y(), o.z()) == -side) low = low.cwiseMin(v), high = high.cwiseMax(v);
    }
  }
  if (high.x() < 0) return;
  const auto reached = [&](const Index3& step) {
    bool all = true;
    for (int a = 0; a < 3; ++a)
      all &= step[a] == 0 || (step[a] < 0 ? low[a] < kMargin : high[a] >= 8 - kMargin);
    return all;
  };
  for (int n = 0; n < 27; ++n) {
    const Index3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    if (sides.blocks.neighbour(b, step.x(), step.y(), step.z()) == kNoBlock && reached(step))
      out.push_back(sides.blocks.origin(b) + 8 * step);
  }
}

// The blocks of a boundary and all that it reaches from them. `read` gives the sides of a block.
template <class Read>
BlockField grownSides(const GridFrame& frame, std::vector<Index3> origins, const Read& read) {
  while (true) {
    BlockField sides{frame, BlockSet(origins), {}};
    sides.values.resize(sides.blocks.count() * kSize);
    forEachBlock(sides.blocks, [&](std::size_t b) { read(sides.blocks.origin(b), sides.block(b)); });
    std::vector<std::vector<Index3>> parts(sides.blocks.count());
    forEachBlock(sides.blocks, [&](std::size_t b) { appendMissing(sides, b, parts[b]); });
    const std::size_t before = origins.size();
    for (const auto& part : parts) origins.insert(origins.end(), part.begin(), part.end());
    if (origins.size() == before) return sides;
  }
}

std::vector<float> moved(const std::vector<float>& values, const BlockSet& from, const BlockSet& to,
                         float missing) {
  std::vector<float> result(to.count() * kSize, missing);
  forEachBlock(to, [&](std::size_t b) {
    const std::uint32_t old = from.find(to.origin(b));
    if (old != kNoBlock) std::copy_n(&values[old * kSize], kSize, &result[b * kSize]);
  });
  return result;
}

// The signed field while it is made. All arrays hold 512 values a block.
struct FieldParts {
  BlockField sides;
  MeasuredField measured;
  std::vector<float> completed;  ///< signed distance, kUnknown where nothing was completed
};

// Distances before smoothing: measured, completed, or half a voxel from the boundary.
std::vector<float> compose(const FieldParts& parts) {
  const std::vector<float> near = nearBoundary(parts.sides);
  const auto voxel = static_cast<float>(parts.sides.frame.voxel);
  const float limit = static_cast<float>(kCutOff) * voxel;
  std::vector<float> field(near.size());
  for (std::size_t i = 0; i < field.size(); ++i) {
    float value = parts.measured.distance[i];
    if (std::isnan(value)) value = parts.completed[i];
    if (std::isnan(value)) value = parts.sides.values[i] * (near[i] > 0 ? 0.5f * voxel : limit);
    field[i] = std::clamp(value, -limit, limit);
  }
  return field;
}

// Gives the side of its voxel to every value. Zero would count as outside, whatever the side.
void putBack(const BlockField& sides, std::vector<float>& field) {
  const float least = kPutBack * static_cast<float>(sides.frame.voxel);
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (!(field[i] * sides.values[i] > 0)) field[i] = sides.values[i] * least;
  }
}

}  // namespace

SurfaceField signedField(const JudgedViews& judged, const LabelledCells& cells, const ScalarGrid& support,
                         const FieldOptions& options, const Progress& progress) {
  const CellLabel beyond = cells.energy.border == Border::Solid ? CellLabel::Inside : CellLabel::Outside;
  const GridFrame& frame = cells.octree.frame;
  FieldParts parts;
  parts.sides = labelSides(cells, beyond);
  std::vector<float> wanted = nearBoundary(parts.sides);
  keepSupported(parts.sides.blocks, support, options.supported, wanted);
  parts.measured = measureDistances(judged, parts.sides, wanted, progress);
  parts.completed.assign(parts.sides.values.size(), kUnknown);
  SurfaceField result{ScalarGrid("surface", frame, kUnknown), {}};
  if (options.completion.kind == CompletionOptions::Kind::Isotropic) {
    const CellPyramid pyramid(cells.octree, cells.labels, cells.support, cells.sigma, cells.energy);
    const Completion completion =
        completeSurface(pyramid, cells.tiles, support, parts.sides.blocks, parts.measured.distance,
                        options.supported, options.completion, progress);
    result.completion = completion.report();
    std::vector<Index3> blocks = parts.sides.blocks.origins();
    completion.appendBlocks(blocks);
    BlockField sides = grownSides(frame, std::move(blocks), [&](const Index3& origin, float* values) {
      completion.readSides(origin, values);
    });
    parts.measured.distance =
        moved(parts.measured.distance, parts.sides.blocks, sides.blocks, kUnknown);
    parts.measured.weight = moved(parts.measured.weight, parts.sides.blocks, sides.blocks, 0.0f);
    wanted = moved(wanted, parts.sides.blocks, sides.blocks, 0.0f);
    parts.sides = std::move(sides);
    parts.completed.assign(parts.sides.values.size(), kUnknown);
    forEachBlock(parts.sides.blocks, [&](std::size_t b) {
      completion.readDistances(parts.sides.blocks.origin(b), &parts.completed[b * kSize]);
    });
  }
  std::vector<float> field = compose(parts);
  const double s0 = env("S0", 1.0), s1 = env("S1", 1.0);
  const int passes = static_cast<int>(env("NR", 1));
  const std::vector<float> ones(field.size(), 1.0f);
  const auto voxel = static_cast<float>(frame.voxel);
  if (s0 > 0) field = smoothed(parts.sides.blocks, field, ones, s0);
  for (int pass = 0; pass < passes; ++pass) {
    BlockField current{frame, parts.sides.blocks, field};
    std::vector<float> close(field.size());
    for (std::size_t i = 0; i < field.size(); ++i)
      close[i] = wanted[i] > 0 && std::abs(field[i]) < 1.5f * voxel ? 1.0f : 0.0f;
    MeasuredField residual = measureResiduals(judged, current, close, progress);
    std::vector<float> change = s1 > 0 ? smoothed(parts.sides.blocks, residual.distance, residual.weight, s1)
                                       : residual.distance;
    for (std::size_t i = 0; i < field.size(); ++i)
      if (close[i] > 0 && !std::isnan(change[i])) field[i] += change[i];
  }
  if (env("SETTLE", 1) > 0) {
    const std::size_t n = settleSides(field, wanted, parts.sides);
    if (getenv("TVLOG")) fprintf(stderr, "settled %zu\n", n);
  }
  putBack(parts.sides, field);
  ScalarGrid grid("surface", frame, kUnknown, parts.sides.blocks.origins());
  grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    const std::size_t b = parts.sides.blocks.find(leaf.origin);
    std::copy_n(&field[b * kSize], kSize, leaf.values.begin());
  });
  grid.setKind(GridKind::LevelSet);
  grid.metadata()["about"] = "signed distance to the surface, > 0 outside";
  result.distance = std::move(grid);
  return result;
}

}  // namespace vdbfuse
