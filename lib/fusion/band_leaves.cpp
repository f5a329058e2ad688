// SPDX-License-Identifier: Apache-2.0
#include "fusion/band_leaves.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fusion/leaf_keys.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/distortion.h"
#include "vdbfuse/geometry/projection.h"

namespace vdbfuse {
namespace {

// Pixels x0 … x1 − 1, y0 … y1 − 1.
struct PixelRect {
  int x0, y0, x1, y1;
};

using DepthRange = DepthTiles::Range;

DepthRange depthRange(const Image<float>& depth, const PixelRect& rect) {
  DepthRange range{std::numeric_limits<float>::infinity(), 0.0f};
  for (int y = rect.y0; y < rect.y1; ++y) {
    const float* row = depth.row(y);
    for (int x = rect.x0; x < rect.x1; ++x) {
      range.least = std::min(range.least, row[x] > 0 ? row[x] : range.least);
      range.most = std::max(range.most, row[x]);
    }
  }
  return range;
}

// Collects the leaves of some tiles, which are mostly neighbours of each other.
class TileLeaves {
 public:
  TileLeaves(const ViewHeader& view, const Image<float>& depth, const GridFrame& frame,
             const BandOptions& options)
      : view_(view),
        depth_(depth),
        options_(options),
        relief_(static_cast<float>(kRelief * options.truncation)) {
    index_from_camera_ = (view.world_from_camera.linear() / frame.voxel).eval();
    origin_ = frame.toIndex(view.world_from_camera.translation());
    const Pinhole* pinhole = std::get_if<Pinhole>(&view.projection);
    has_straight_rays_ = pinhole != nullptr && !isDistorted(*pinhole);
    if (has_straight_rays_) {
      first_step_ = rayAt(0, 0).step;
      step_by_x_ = rayAt(1, 0).step - first_step_, step_by_y_ = rayAt(0, 1).step - first_step_;
    }
    if (options.domain) {
      low_ = frame.toIndex(options.domain->min()).array().max(-kFarthest);
      high_ = frame.toIndex(options.domain->max()).array().min(kFarthest);
    }
  }

  void visit(const PixelRect& rect) { visit(rect, depthRange(depth_, rect)); }
  void visit(const PixelRect& rect, const DepthRange& range) {
    if (range.most <= 0) return;
    if (range.most - range.least <= relief_ || (rect.x1 - rect.x0 == 1 && rect.y1 - rect.y0 == 1))
      return touch(rect, range);
    const int x = (rect.x0 + rect.x1 + 1) / 2, y = (rect.y0 + rect.y1 + 1) / 2;
    visit({rect.x0, rect.y0, x, y});
    if (x < rect.x1) visit({x, rect.y0, rect.x1, y});
    if (y < rect.y1) visit({rect.x0, y, x, rect.y1});
    if (x < rect.x1 && y < rect.y1) visit({x, y, rect.x1, rect.y1});
  }

  std::vector<std::uint64_t> take() { return found_.take(); }

 private:
  static constexpr double kRelief = 2;
  static constexpr double kFarthest = ScalarGrid::kLeafSide * static_cast<double>(kLeafKeyReach);

  // Points along the ray of a pixel are start + depth·step (geometry/projection.h).
  struct Ray {
    Eigen::Vector3d start, step;
  };
  Ray rayAt(double x, double y) const {
    const Eigen::Vector3d zero = unproject(view_.projection, x, y, 0.0),
                          one = unproject(view_.projection, x, y, 1.0);
    return {origin_ + index_from_camera_ * zero, index_from_camera_ * (one - zero)};
  }

  void touch(const PixelRect& rect, const DepthRange& range) {
    const double nearest = std::max(0.0, range.least - options_.truncation),
                 furthest = range.most + options_.truncation;
    if (!has_straight_rays_) return touchBent(rect, nearest, furthest);
    // The extreme steps of the rectangle's rays, then the extreme places along them.
    const Eigen::Array3d left = (rect.x0 - 0.5) * step_by_x_.array(),
                         right = (rect.x1 - 0.5) * step_by_x_.array();
    const Eigen::Array3d top = (rect.y0 - 0.5) * step_by_y_.array(),
                         bottom = (rect.y1 - 0.5) * step_by_y_.array();
    const Eigen::Array3d least = first_step_.array() + left.min(right) + top.min(bottom),
                         most = first_step_.array() + left.max(right) + top.max(bottom);
    touch(origin_.array() + (nearest * least).min(furthest * least),
          origin_.array() + (nearest * most).max(furthest * most));
  }

  // Sensors whose rays are not linear in the pixel.
  void touchBent(const PixelRect& rect, double nearest, double furthest) {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const double x : {rect.x0 - 0.5, rect.x1 - 0.5}) {
      for (const double y : {rect.y0 - 0.5, rect.y1 - 0.5}) {
        const Ray ray = rayAt(x, y);
        box.extend(ray.start + nearest * ray.step), box.extend(ray.start + furthest * ray.step);
        mean += 0.25 * (ray.start + furthest * ray.step);
      }
    }
    // Not flat between its corners.
    const Ray middle = rayAt(0.5 * (rect.x0 + rect.x1 - 1), 0.5 * (rect.y0 + rect.y1 - 1));
    const double bulge = (middle.start + furthest * middle.step - mean).norm();
    touch(box.min().array() - bulge, box.max().array() + bulge);
  }

  // Leaves with voxels between two places in the grid.
  void touch(const Eigen::Array3d& low, const Eigen::Array3d& high) {
    // Within ±2²³: integers hold them.
    const Eigen::Array3i first = low.max(low_).ceil().cast<int>(), last = high.min(high_).floor().cast<int>();
    if ((last < first).any()) return;
    const Index3 from(first.x() >> 3, first.y() >> 3, first.z() >> 3),
        to(last.x() >> 3, last.y() >> 3, last.z() >> 3);
    if ((to - from).cast<double>().array().operator+(1).prod() > kMostLeavesOfAPixel) return;
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y)
        for (int z = from.z(); z <= to.z(); ++z) found_.add(leafKey(x, y, z));
  }

  const ViewHeader& view_;
  const Image<float>& depth_;
  const BandOptions& options_;
  float relief_;  ///< depths in a tile that lie further apart are taken apart
  Eigen::Matrix3d index_from_camera_;
  Eigen::Vector3d origin_;
  bool has_straight_rays_ = false;  ///< an undistorted pinhole: steps are linear in the pixel
  Eigen::Vector3d first_step_, step_by_x_, step_by_y_;
  Eigen::Array3d low_ = Eigen::Array3d::Constant(-kFarthest), high_ = Eigen::Array3d::Constant(kFarthest);
  LeafKeyCollector found_;
};

// One list out of two halves of a list of lists, all sorted.
std::vector<std::uint64_t> merged(std::vector<std::vector<std::uint64_t>>& parts, std::size_t begin,
                                  std::size_t end) {
  if (end - begin == 1) return std::move(parts[begin]);
  const std::size_t middle = (begin + end) / 2;
  const std::vector<std::uint64_t> a = merged(parts, begin, middle), b = merged(parts, middle, end);
  std::vector<std::uint64_t> result;
  result.reserve(a.size() + b.size());
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
  return result;
}

}  // namespace

std::vector<Index3> bandLeaves(const ViewHeader& view, const Image<float>& depth, const DepthTiles& tiles,
                               const GridFrame& frame, const BandOptions& options) {
  constexpr int kSide = DepthTiles::kSide;
  constexpr std::size_t kRowsPerTask = 8;
  const int columns = tiles.least.width();
  const auto rows = static_cast<std::size_t>(tiles.least.height());
  std::vector<std::vector<std::uint64_t>> parts(chunkCount(rows, kRowsPerTask));
  parallelFor(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    TileLeaves leaves(view, depth, frame, options);
    for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      for (int column = 0; column < columns; ++column) {
        const int x = column * kSide, y = row * kSide;
        leaves.visit({x, y, std::min(x + kSide, depth.width()), std::min(y + kSide, depth.height())},
                     {tiles.least(column, row), tiles.most(column, row)});
      }
    }
    parts[begin / kRowsPerTask] = leaves.take();
  });
  std::vector<Index3> origins;
  if (parts.empty()) return origins;
  for (const std::uint64_t key : merged(parts, 0, parts.size()))
    origins.emplace_back(ScalarGrid::kLeafSide * placeOfLeaf(key));
  return origins;
}

}  // namespace vdbfuse
