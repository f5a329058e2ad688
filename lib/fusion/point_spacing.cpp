// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/point_spacing.h"

#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <numbers>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kViews = 16;
constexpr float kDoubtful = 0.5f;
constexpr int kPatch = 24, kPatchesPerSide = 4;
// On a square lattice the eighth nearest neighbour is a diagonal away.
constexpr std::size_t kNeighbours = 8;
constexpr float kDiagonal = std::numbers::sqrt2_v<float>;

void takePatch(const JudgedView& view, int left, int top, std::vector<Eigen::Vector3f>& points) {
  const Image<float>& depth = view.depth;
  for (int y = std::max(0, top); y < std::min(depth.height(), top + kPatch); ++y) {
    for (int x = std::max(0, left); x < std::min(depth.width(), left + kPatch); ++x) {
      if (depth(x, y) == kInvalidDepth || view.outlier(x, y) >= kDoubtful) continue;
      const Eigen::Vector3d point = unproject(view.projection, x, y, depth(x, y));
      points.push_back((view.world_from_camera * point).cast<float>());
    }
  }
}

std::vector<float> spacings(std::vector<Eigen::Vector3f>& points) {
  std::vector<float> result;
  if (points.size() <= kNeighbours) return result;
  const flann::Matrix<float> all(points.front().data(), points.size(), 3);
  flann::Index<flann::L2<float>> index(all, flann::KDTreeSingleIndexParams());
  index.buildIndex();
  std::vector<std::vector<std::size_t>> found;
  std::vector<std::vector<float>> squared;
  index.knnSearch(all, found, squared, kNeighbours + 1, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  for (const std::vector<float>& d : squared) result.push_back(std::sqrt(d.back()) / kDiagonal);
  return result;
}

std::vector<float> viewSpacings(const JudgedView& view) {
  std::vector<float> result;
  const Image<float>& depth = view.depth;
  for (int row = 0; row < kPatchesPerSide; ++row) {
    for (int column = 0; column < kPatchesPerSide; ++column) {
      const int left = depth.width() * (2 * column + 1) / (2 * kPatchesPerSide) - kPatch / 2;
      const int top = depth.height() * (2 * row + 1) / (2 * kPatchesPerSide) - kPatch / 2;
      std::vector<Eigen::Vector3f> points;
      takePatch(view, left, top, points);
      const std::vector<float> patch = spacings(points);
      result.insert(result.end(), patch.begin(), patch.end());
    }
  }
  return result;
}

}  // namespace

double pointSpacing(const JudgedViews& judged) {
  const std::vector<JudgedView>& views = judged.views;
  const std::size_t count = std::min(kViews, views.size());
  std::vector<std::vector<float>> by_view(count);
  parallelFor(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const JudgedView& view = views[i * views.size() / count];
      by_view[i] = viewSpacings(view);
      letGo(view);
    }
  });
  std::vector<float> all;
  for (const std::vector<float>& spacing : by_view) all.insert(all.end(), spacing.begin(), spacing.end());
  if (all.empty()) return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return static_cast<double>(*middle);
}

}  // namespace vdbfuse
