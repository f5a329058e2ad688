// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/measurement_weight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fusion/weight_kernels.h"
#include "vdbfuse/base/rows.h"
#include "vdbfuse/geometry/projection.h"

namespace vdbfuse {
namespace {

constexpr int kNormalRadius = 2;                                        // pixels
constexpr std::array<float, 3> kRamp = {1 / 7.0f, 3 / 7.0f, 5 / 7.0f};  // at an edge, one step from it, two
// What is more likely wrong than three to one is not used: many of them add up to floating pieces.
constexpr float kLeastReliable = 0.25f;
constexpr std::size_t kRowsPerTask = 32;

// weights(x, y) *= factor(x, y).
template <class Factor>
void multiply(Image<float>& weights, const Factor& factor) {
  forEachRow(weights.height(), kRowsPerTask, [&](int y) {
    float* row = weights.row(y);
    for (int x = 0; x < weights.width(); ++x) row[x] *= factor(x, y);
  });
}

RowWeighting noiseWeighting(const NoiseLaw& noise, double voxel) {
  RowWeighting w;
  w.has_noise = true;
  w.noise = NoiseCurve(noise);
  w.half_voxel_squared = static_cast<float>(0.25 * voxel * voxel);
  return w;
}

// The products that a depth map and its sensor give by themselves. `pinhole`: incidence is one of them.
Image<float> weighRows(const Image<float>& depth, RowWeighting weighting, const Pinhole* pinhole,
                       const DepthEdge& edge, bool has_silhouette) {
  const int width = depth.width(), height = depth.height(), radius = kNormalRadius;
  std::vector<float> us;
  if (pinhole != nullptr) {
    us.resize(static_cast<std::size_t>(width));
    for (int x = 0; x < width; ++x)
      us[static_cast<std::size_t>(x)] = static_cast<float>((x - pinhole->cx) / pinhole->fx);
    weighting.radius = radius;
    weighting.per_x = static_cast<float>(pinhole->fx / (2 * radius));
    weighting.per_y = static_cast<float>(pinhole->fy / (2 * radius));
    weighting.jump = 2 * radius * edge.relative;
  }
  std::optional<EdgeBands> bands;
  if (has_silhouette) bands = edgeBands(depth, edge);
  weighting.ramp = kRamp;
  Image<float> weights(width, height);
  forEachRow(height, kRowsPerTask, [&](int y) {
    RowWeighting row = weighting;
    if (bands) {
      row.bands = {bands->at.row(y), bands->within_one.row(y), bands->within_two.row(y)};
      row.lone = bands->lone.row(y);
    }
    const bool is_border = y < radius || y >= height - radius;
    if (pinhole != nullptr && !is_border)
      row.us = us.data(), row.v = static_cast<float>((y - pinhole->cy) / pinhole->fy);
    const DepthRows rows{depth.row(std::max(y - radius, 0)), depth.row(y),
                         depth.row(std::min(y + radius, height - 1)), width};
    weighRow(rows, row, weights.row(y));
    if (pinhole != nullptr && is_border)
      for (int x = 0; x < width; ++x) weights(x, y) *= kUnknownCosine;
  });
  return weights;
}

// Incidence of any sensor, from points.
float cosineAt(const Projection& projection, const Image<float>& depth, const DepthEdge& edge, int x, int y) {
  constexpr int k = kNormalRadius;
  if (x < k || y < k || x >= depth.width() - k || y >= depth.height() - k) return kUnknownCosine;
  const float z = depth(x, y);
  const auto [least, most] =
      std::minmax({depth(x - k, y), depth(x + k, y), depth(x, y - k), depth(x, y + k)});
  if (!(z > 0) || !(least > 0) || most - least > 2 * k * (edge.relative * z + edge.absolute))
    return kUnknownCosine;
  const auto point = [&](int px, int py) { return unproject(projection, px, py, depth(px, py)); };
  const Eigen::Vector3d a = point(x + k, y) - point(x - k, y), b = point(x, y + k) - point(x, y - k);
  const Eigen::Vector3d normal = a.cross(b);
  const double length = normal.norm();
  if (!(length > 0)) return kUnknownCosine;
  return static_cast<float>(std::abs(normal.dot(rayDirection(projection, x, y, z))) / length);
}

}  // namespace

Image<float> measurementWeights(const View& view, const std::optional<NoiseLaw>& noise, double voxel,
                                const WeightOptions& options) {
  const Image<float>& depth = view.map.depth;
  const DepthEdge edge = depthEdge(view.projection, voxel);
  const Pinhole* pinhole = std::get_if<Pinhole>(&view.projection);
  const RowWeighting weighting = options.noise && noise ? noiseWeighting(*noise, voxel) : RowWeighting();
  Image<float> weights =
      weighRows(depth, weighting, options.incidence ? pinhole : nullptr, edge, options.silhouette);
  if (options.incidence && pinhole == nullptr) {
    multiply(weights, [&](int x, int y) { return cosineAt(view.projection, depth, edge, x, y); });
  }
  if (options.confidence && !view.map.confidence.empty()) {
    multiply(weights, [&](int x, int y) {
      const float c = view.map.confidence(x, y);
      return std::isfinite(c) ? std::clamp(c, 0.0f, 1.0f) : 1.0f;
    });
  }
  return weights;
}

Image<float> measurementWeights(const JudgedView& view, const NoiseLaw& noise, double voxel,
                                const WeightOptions& options) {
  const RowWeighting weighting = options.noise ? noiseWeighting(noise, voxel) : RowWeighting();
  Image<float> weights =
      weighRows(view.depth, weighting, nullptr, depthEdge(view.projection, voxel), options.silhouette);
  if (options.confidence) {
    multiply(weights, [&](int x, int y) {
      const float right = 1 - view.outlier(x, y);
      return right < kLeastReliable ? 0.0f : right;
    });
  }
  if (options.incidence) {
    multiply(weights, [&](int x, int y) {
      const float cosine = view.incidence(x, y);
      return cosine > 0 ? cosine : kUnknownCosine;
    });
  }
  return weights;
}

}  // namespace vdbfuse
