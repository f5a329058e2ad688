// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/field.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "surface/label_blocks.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/sensor/view_windows.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr int kReach = 4;             // voxels around the boundary that are looked at
constexpr double kCutOff = 2.0;       // voxels: largest distance that is kept
constexpr double kSameSide = 1.5;     // noise widths or voxels: beyond this a view sees another surface
constexpr float kPutBack = 0.05f;     // voxels: what a voxel gets whose smoothed value has the wrong sign
constexpr float kLeastCosine = 0.2f;  // incidence of pixels without a normal
constexpr std::size_t kLeavesPerTask = 8;
constexpr std::size_t kLeavesPerPass = 16384;  // at most 200 MB of sums

// A leaf with a margin of R voxels taken from its 26 neighbours.
template <int R>
struct Padded {
  static constexpr int kSide = 8 + 2 * R;
  std::array<float, static_cast<std::size_t>(kSide* kSide* kSide)> values;
  float& at(int x, int y, int z) {
    return values[static_cast<std::size_t>(((x + R) * kSide + y + R) * kSide + z + R)];
  }
  float at(int x, int y, int z) const {
    return values[static_cast<std::size_t>(((x + R) * kSide + y + R) * kSide + z + R)];
  }
};

template <int R>
Padded<R> loadPadded(const ScalarGrid& grid, const Index3& origin) {
  Padded<R> result;
  result.values.fill(kUnknown);
  for (int n = 0; n < 27; ++n) {
    const Index3 offset = 8 * (Index3(n % 3, n / 3 % 3, n / 9).array() - 1).matrix();
    const std::optional<std::size_t> found = grid.findLeaf(origin + offset);
    if (!found) continue;
    const ScalarGrid::Leaf leaf = grid.leaf(*found);
    const Index3 low = offset.cwiseMax(-R), high = (offset.array() + 8).min(8 + R);
    for (int x = low.x(); x < high.x(); ++x) {
      for (int y = low.y(); y < high.y(); ++y) {
        for (int z = low.z(); z < high.z(); ++z) {
          result.at(x, y, z) = leaf.at(x - offset.x(), y - offset.y(), z - offset.z());
        }
      }
    }
  }
  return result;
}

// Sums for the mean signed distance that the depth maps give a voxel.
struct DistanceSum {
  double distance = 0, weight = 0;
};

// What the views that see this side of the surface measured.
class DistanceMeter {
 public:
  DistanceMeter(const SensorModel& sensor, double voxel) : sensor_(sensor), voxel_(voxel) {}

  void add(const JudgedView& view, const Sighting& seen, CellLabel label, DistanceSum& sum) const {
    const float measured = view.depth(seen.x, seen.y);
    if (measured == kInvalidDepth) return;
    const double distance = measured - seen.depth;
    if (std::abs(distance) > 3 * voxel_ + 3 * sensor_.noise.at(measured)) return;
    const double noise = lookupNoise(sensor_, view.projection, measured);
    const double contradiction = label == CellLabel::Outside ? -distance : distance;
    if (contradiction > kSameSide * std::max(voxel_, noise)) return;
    const double cosine = std::max(view.incidence(seen.x, seen.y), kLeastCosine);
    const double weight =
        view.weight * (1 - view.outlier(seen.x, seen.y)) * cosine * cosine / (noise * noise);
    sum.distance += weight * distance * cosine;
    sum.weight += weight;
  }

 private:
  const SensorModel& sensor_;
  double voxel_;
};

float towards(CellLabel label, float magnitude) {
  return label == CellLabel::Outside ? magnitude : -magnitude;
}
CellLabel labelOf(float sign) { return sign > 0 ? CellLabel::Outside : CellLabel::Inside; }
// Zero would count as outside when triangles are made, whatever the label says.
bool agrees(float value, CellLabel label) { return label == CellLabel::Outside ? value > 0 : value < 0; }

// Grid of +1 (outside) and −1 (inside) on all blocks around the boundary.
ScalarGrid labelGrid(const Octree& octree, const std::vector<CellLabel>& labels, CellLabel beyond,
                     std::vector<Index3> blocks) {
  ScalarGrid grid("labels", octree.frame, kUnknown, std::move(blocks));
  const LabelReader reader(octree, labels, beyond);
  grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    std::array<CellLabel, ScalarGrid::kLeafSize> block;
    reader.readBlock(leaf.origin, block.data());
    std::transform(block.begin(), block.end(), leaf.values.begin(),
                   [](CellLabel l) { return towards(l, 1.0f); });
  });
  return grid;
}

// Whether a voxel has another label within two voxels along some axis or diagonal neighbour.
bool isNearBoundary(const Padded<2>& labels, const Index3& v) {
  const float own = labels.at(v.x(), v.y(), v.z());
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        if (labels.at(v.x() + x, v.y() + y, v.z() + z) == -own) return true;
      }
    }
  }
  return false;
}

// A voxel of a leaf that is measured.
struct MeasuredVoxel {
  int place = 0;
  CellLabel label = CellLabel::Outside;
  DistanceSum sum;
};

// First values: half a voxel near the boundary, the cut-off far from it. Returns the voxels near it that are
// supported: those have a measured distance.
std::vector<MeasuredVoxel> startLeaf(const ScalarGrid& labels, const ScalarGrid& support,
                                     const FieldOptions& options, const ScalarGrid::Leaf& out) {
  const Padded<2> near = loadPadded<2>(labels, out.origin);
  const float voxel = static_cast<float>(labels.frame().voxel);
  const std::optional<std::size_t> found = support.findLeaf(out.origin);
  std::vector<MeasuredVoxel> measured;
  for (int i = 0; i < ScalarGrid::kLeafSize; ++i) {
    const Index3 v = leafOffset(i);
    const CellLabel label = labelOf(near.at(v.x(), v.y(), v.z()));
    const bool is_near = isNearBoundary(near, v);
    out.values[static_cast<std::size_t>(i)] =
        towards(label, (is_near ? 0.5f : static_cast<float>(kCutOff)) * voxel);
    const float agreement =
        found ? support.leaf(*found).values[static_cast<std::size_t>(i)] : support.background();
    if (is_near && agreement >= options.supported) measured.push_back({i, label, {}});
  }
  return measured;
}

void addViews(const std::vector<const JudgedView*>& views, const std::vector<Projector>& projectors,
              const DistanceMeter& meter, const GridFrame& frame, const Index3& origin,
              std::vector<MeasuredVoxel>& voxels) {
  if (voxels.empty()) return;
  constexpr double kLeafRadius = 0.5 * ScalarGrid::kLeafSide * 1.7320508;
  const Eigen::Vector3d centre =
      frame.toWorld(Eigen::Vector3d(origin.cast<double>().array() + 0.5 * (ScalarGrid::kLeafSide - 1)));
  for (std::size_t k = 0; k < views.size(); ++k) {
    if (!projectors[k].mightSee(centre, kLeafRadius * frame.voxel)) continue;
    for (MeasuredVoxel& voxel : voxels) {
      const auto seen = projectors[k](frame.toWorld(Index3(origin + leafOffset(voxel.place))));
      if (seen) meter.add(*views[k], *seen, voxel.label, voxel.sum);
    }
  }
}

void setMeasured(const std::vector<MeasuredVoxel>& voxels, float voxel_size, const ScalarGrid::Leaf& out) {
  const float limit = static_cast<float>(kCutOff) * voxel_size;
  for (const MeasuredVoxel& voxel : voxels) {
    if (!(voxel.sum.weight > 0)) continue;
    float& value = out.values[static_cast<std::size_t>(voxel.place)];
    value = std::clamp(static_cast<float>(voxel.sum.distance / voxel.sum.weight), -limit, limit);
    if (!agrees(value, voxel.label)) value = towards(voxel.label, kPutBack * voxel_size);
  }
}

// First values of leaves [begin, end). Windows of views pass by on the outside.
void measureLeaves(const JudgedViews& judged, const ScalarGrid& labels, const ScalarGrid& support,
                   const FieldOptions& options, std::size_t begin, std::size_t end, ScalarGrid& out) {
  const GridFrame& frame = labels.frame();
  const DistanceMeter meter(judged.sensor, frame.voxel);
  std::vector<std::vector<MeasuredVoxel>> voxels(end - begin);
  const auto for_each_leaf = [&](const auto& visit) {
    parallelFor(end - begin, kLeavesPerTask, [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) visit(out.leaf(begin + i), voxels[i]);
    });
  };
  for_each_leaf([&](const ScalarGrid::Leaf& leaf, std::vector<MeasuredVoxel>& measured) {
    measured = startLeaf(labels, support, options, leaf);
  });
  forEachWindow(judged.views, [&](std::size_t first, std::size_t last) {
    std::vector<const JudgedView*> views;
    std::vector<Projector> projectors;
    for (std::size_t i = first; i < last; ++i) {
      views.push_back(&judged.views[i]);
      projectors.emplace_back(judged.views[i].projection, judged.views[i].world_from_camera);
    }
    for_each_leaf([&](const ScalarGrid::Leaf& leaf, std::vector<MeasuredVoxel>& measured) {
      addViews(views, projectors, meter, frame, leaf.origin, measured);
    });
  });
  for_each_leaf([&](const ScalarGrid::Leaf& leaf, const std::vector<MeasuredVoxel>& measured) {
    setMeasured(measured, static_cast<float>(frame.voxel), leaf);
  });
}

std::array<float, 5> gaussianWeights(double sigma) {
  std::array<float, 5> weights;
  for (int k = -2; k <= 2; ++k)
    weights[static_cast<std::size_t>(k + 2)] = static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma)));
  return weights;
}

// Gaussian along one axis over the known values of a padded leaf; the margin along the other axes shrinks
// later.
void smoothAxis(Padded<2>& patch, int axis, const std::array<float, 5>& weights) {
  const Padded<2> in = patch;
  const Index3 step = Index3::Unit(axis);
  Index3 low(-2, -2, -2), high(10, 10, 10);
  low[axis] = 0, high[axis] = 8;
  for (int x = low.x(); x < high.x(); ++x) {
    for (int y = low.y(); y < high.y(); ++y) {
      for (int z = low.z(); z < high.z(); ++z) {
        float sum = 0, total = 0;
        for (int k = -2; k <= 2; ++k) {
          const float value = in.at(x + k * step.x(), y + k * step.y(), z + k * step.z());
          if (std::isnan(value)) continue;
          sum += weights[static_cast<std::size_t>(k + 2)] * value;
          total += weights[static_cast<std::size_t>(k + 2)];
        }
        patch.at(x, y, z) = total > 0 ? sum / total : kUnknown;
      }
    }
  }
}

void smoothLeaf(const ScalarGrid& field, const ScalarGrid& labels, const std::array<float, 5>& weights,
                const ScalarGrid::Leaf& out) {
  Padded<2> patch = loadPadded<2>(field, out.origin);
  for (int axis = 0; axis < 3; ++axis) smoothAxis(patch, axis, weights);
  const ScalarGrid::Leaf sides = labels.leaf(*labels.findLeaf(out.origin));
  const float least = kPutBack * static_cast<float>(field.frame().voxel);
  for (int i = 0; i < ScalarGrid::kLeafSize; ++i) {
    const Index3 v = leafOffset(i);
    const CellLabel label = labelOf(sides.values[static_cast<std::size_t>(i)]);
    const float value = patch.at(v.x(), v.y(), v.z());
    out.values[static_cast<std::size_t>(i)] = agrees(value, label) ? value : towards(label, least);
  }
}

}  // namespace

ScalarGrid signedField(const JudgedViews& judged, const Octree& octree, const CellTiles& tiles,
                       const std::vector<CellLabel>& labels, const ScalarGrid& support,
                       const FieldOptions& options, const Progress& progress) {
  const std::vector<Index3> blocks = boundaryBlocks(octree, tiles, labels, options.beyond, kReach);
  const ScalarGrid sides = labelGrid(octree, labels, options.beyond, blocks);
  ScalarGrid measured("surface", octree.frame, kUnknown, blocks);
  ProgressStep step(progress, "place surface", measured.leafCount());
  for (std::size_t begin = 0; begin < measured.leafCount(); begin += kLeavesPerPass) {
    const std::size_t end = std::min(begin + kLeavesPerPass, measured.leafCount());
    measureLeaves(judged, sides, support, options, begin, end, measured);
    step.advance(end - begin);
  }
  measured.setKind(GridKind::LevelSet);
  measured.metadata()["about"] = "signed distance to the surface, > 0 outside";
  if (!(options.smoothing_voxels > 0)) return measured;
  ScalarGrid smooth("surface", octree.frame, kUnknown, blocks);
  const std::array<float, 5> weights = gaussianWeights(options.smoothing_voxels);
  smooth.forEachLeaf([&](const ScalarGrid::Leaf& leaf) { smoothLeaf(measured, sides, weights, leaf); });
  smooth.setKind(GridKind::LevelSet);
  smooth.metadata() = measured.metadata();
  return smooth;
}

}  // namespace vdbfuse
