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

// What one point finds in the other views.
struct Votes {
  double agree = 0, conflict = 0;
};

// How far a point behind another view's surface speaks against the reading: views that look the same way see
// the same surfaces, views from opposite sides rightly see none of each other's.
double weightOfHidden(const SampledView& a, const SampledView& b, const RigidTransform& b_from_a) {
  constexpr double kAnyDirection = 0.25;
  const auto looks_all_around = [](const SampledView& v) {
    return std::holds_alternative<Spherical>(v.view.projection);
  };
  if (looks_all_around(a) || looks_all_around(b)) return kAnyDirection;
  const double cosine = std::max(0.0, b_from_a.linear()(2, 2));
  return cosine * cosine * cosine * cosine;
}

// Looks every point of one view up in another.
void ask(const SampledView& from, const SampledView& to, const RigidTransform& to_from_from,
         const Convention& convention, double tolerance, std::vector<Votes>& votes) {
  const DepthReader from_depth(from.view.projection, convention), to_depth(to.view.projection, convention);
  const Image<float>& depth = to.view.map.depth;
  const double hidden = weightOfHidden(from, to, to_from_from);
  for (std::size_t i = 0; i < from.pixels.size(); ++i) {
    const SampledPixel& p = from.pixels[i];
    const Eigen::Vector3d point =
        to_from_from * unproject(from.view.projection, p.x, p.y, from_depth(p.x, p.y, p.depth));
    const auto seen = project(to.view.projection, point);
    if (!seen || !(std::abs(seen->x) < 1e6 && std::abs(seen->y) < 1e6)) continue;
    const int x = nearestPixel(seen->x), y = nearestPixel(seen->y);
    if (!depth.contains(x, y) || depth(x, y) == kInvalidDepth) continue;
    const double behind = seen->depth - to_depth(x, y, depth(x, y));
    if (std::abs(behind) <= tolerance)
      votes[i].agree += 1;
    else
      votes[i].conflict += behind < 0 ? 1 : hidden;
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
  double consistent = 0, inconsistent = 0, all = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    std::vector<Votes> votes(views[i].pixels.size());
    for (std::size_t j = 0; j < views.size(); ++j) {
      if (i == j) continue;
      ask(views[i], views[j], poses[j].inverse() * poses[i], convention, convention.depth_factor * tolerance,
          votes);
    }
    // By majority, so that a wrong depth spoils its own vote and few others.
    for (const Votes& v : votes) {
      consistent += v.agree > v.conflict ? 1 : 0;
      inconsistent += v.agree <= v.conflict && v.conflict > 0 ? 1 : 0;
    }
    all += static_cast<double>(votes.size());
  }
  // A handful of points that agree by chance must not look like agreement.
  constexpr double kDoubt = 0.02;
  return consistent / (consistent + inconsistent + kDoubt * all);
}

}  // namespace vdbfuse
