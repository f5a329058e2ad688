// SPDX-License-Identifier: Apache-2.0
#include "fusion/convention_rating.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

// Pixels of a regular grid over the image that has about `count` valid ones.
std::vector<SampledPixel> spreadPixels(const Image<float>& depth, std::size_t count) {
  const auto valid = static_cast<std::size_t>(
      std::count_if(depth.begin(), depth.end(), [](float d) { return d != kInvalidDepth; }));
  std::vector<SampledPixel> pixels;
  if (valid == 0) return pixels;
  // Every n-th valid pixel, n prime to the width of most images, so that columns do not line up.
  const std::size_t every = std::max<std::size_t>(1, valid / count) | 1;
  std::size_t next = every / 2;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (depth(x, y) == kInvalidDepth || next-- > 0) continue;
      pixels.push_back({x, y, depth(x, y)});
      next = every - 1;
    }
  }
  return pixels;
}

double sizeOf(const SampledView& sampled) {
  constexpr double kTail = 0.05;
  Eigen::Vector3d size;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const SampledPixel& p : sampled.pixels)
      values.push_back(unproject(sampled.view.projection, p.x, p.y, p.depth)[axis]);
    std::sort(values.begin(), values.end());
    const auto tail = static_cast<std::size_t>(kTail * static_cast<double>(values.size()));
    size[axis] = values[values.size() - 1 - tail] - values[tail];
  }
  return size.norm();
}

// What the points of one view find in another.
struct Tally {
  double seen = 0, agree = 0, conflict = 0;
};

void compare(const SampledView& from, const RigidTransform& from_pose, const SampledView& to,
             const RigidTransform& to_pose, const Convention& convention, double tolerance, Tally& tally) {
  const DepthReader from_depth(from.view.projection, convention), to_depth(to.view.projection, convention);
  const RigidTransform to_from_from = to_pose.inverse() * from_pose;
  const Image<float>& depth = to.view.map.depth;
  for (const SampledPixel& p : from.pixels) {
    const Eigen::Vector3d point =
        to_from_from * unproject(from.view.projection, p.x, p.y, from_depth(p.x, p.y, p.depth));
    const auto seen = project(to.view.projection, point);
    tally.seen += 1;
    if (!seen || !(std::abs(seen->x) < 1e6 && std::abs(seen->y) < 1e6)) continue;
    const int x = nearestPixel(seen->x), y = nearestPixel(seen->y);
    if (!depth.contains(x, y) || depth(x, y) == kInvalidDepth) continue;
    const double behind = seen->depth - to_depth(x, y, depth(x, y));
    if (std::abs(behind) <= tolerance)
      tally.agree += 1;
    else if (behind < 0)
      tally.conflict += 1;
  }
}

}  // namespace

std::vector<SampledView> sampleViews(const ViewSequence& views,
                                     const std::vector<RigidTransform>& stored_from_camera,
                                     const ConventionOptions& options) {
  std::vector<SampledView> sampled;
  const std::size_t count = std::min(options.views, views.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t index = k * views.size() / count;
    SampledView view{views.load(index), RigidTransform::Identity(), {}};
    if (!stored_from_camera.empty()) view.stored_from_camera = stored_from_camera[index];
    view.view.map.color = {};
    view.pixels = spreadPixels(view.view.map.depth, options.samples);
    if (!view.pixels.empty()) sampled.push_back(std::move(view));
  }
  return sampled;
}

double typicalSize(const std::vector<SampledView>& views) {
  std::vector<double> sizes;
  for (const SampledView& view : views) sizes.push_back(sizeOf(view));
  std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2), sizes.end());
  return sizes[sizes.size() / 2];
}

double agreementUnder(const std::vector<SampledView>& views, const Convention& convention, double tolerance) {
  std::vector<RigidTransform> poses;
  for (const SampledView& v : views)
    poses.push_back(poseUnder(v.view.world_from_camera, v.stored_from_camera, convention));
  Tally tally;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < views.size(); ++j) {
      if (i != j)
        compare(views[i], poses[i], views[j], poses[j], convention, convention.depth_factor * tolerance,
                tally);
    }
  }
  // A handful of points that agree by chance must not look like agreement.
  constexpr double kDoubt = 0.02;
  return tally.agree / (tally.agree + tally.conflict + kDoubt * tally.seen + 1e-12);
}

}  // namespace vdbfuse
