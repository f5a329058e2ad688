// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

// Exact extremes and a sample of the values between them.
struct Values {
  float smallest = std::numeric_limits<float>::infinity();
  float largest = -std::numeric_limits<float>::infinity();
  std::vector<float> sample;

  void extend(float value) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  void append(const Values& other) {
    smallest = std::min(smallest, other.smallest);
    largest = std::max(largest, other.largest);
    sample.insert(sample.end(), other.sample.begin(), other.sample.end());
  }
};

// What one view, or all views together, contribute.
struct Tally {
  std::size_t with_confidence = 0, with_color = 0;
  std::uint64_t pixels = 0, valid = 0;
  Values depth, confidence;
  std::array<std::vector<float>, 3> points;  // a coordinate each

  void append(const Tally& other) {
    with_confidence += other.with_confidence, with_color += other.with_color;
    pixels += other.pixels, valid += other.valid;
    depth.append(other.depth), confidence.append(other.confidence);
    for (std::size_t axis = 0; axis < 3; ++axis)
      points[axis].insert(points[axis].end(), other.points[axis].begin(), other.points[axis].end());
  }
};

void takeSample(const View& view, int x, int y, Tally& tally) {
  tally.depth.sample.push_back(view.map.depth(x, y));
  const Eigen::Vector3f point = worldPoint(view, x, y).cast<float>();
  for (std::size_t axis = 0; axis < 3; ++axis) tally.points[axis].push_back(point[static_cast<int>(axis)]);
}

// Every stride-th valid pixel is sampled.
Tally tallyView(const View& view, std::uint64_t stride) {
  Tally tally;
  const DepthMap& map = view.map;
  tally.with_confidence = map.confidence.empty() ? 0 : 1;
  tally.with_color = map.color.empty() ? 0 : 1;
  tally.pixels = map.depth.size();
  for (int y = 0; y < map.depth.height(); ++y) {
    for (int x = 0; x < map.depth.width(); ++x) {
      if (map.depth(x, y) == kInvalidDepth) continue;
      const bool sampled = tally.valid++ % stride == 0;
      tally.depth.extend(map.depth(x, y));
      if (sampled) takeSample(view, x, y, tally);
      if (map.confidence.empty() || !std::isfinite(map.confidence(x, y))) continue;
      tally.confidence.extend(map.confidence(x, y));
      if (sampled) tally.confidence.sample.push_back(map.confidence(x, y));
    }
  }
  return tally;
}

// REQUIRES: values is not empty. Reorders them.
double quantile(std::vector<float>& values, double share) {
  const auto rank = static_cast<std::ptrdiff_t>(std::lround(share * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

std::optional<Spread> spreadOf(Values values, double tail) {
  if (values.sample.empty()) return std::nullopt;
  return Spread{values.smallest, quantile(values.sample, tail), quantile(values.sample, 0.5),
                quantile(values.sample, 1.0 - tail), values.largest};
}

Box boxOf(std::array<std::vector<float>, 3> points, double tail) {
  Box box;
  if (points[0].empty()) return box;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float>& coordinates = points[static_cast<std::size_t>(axis)];
    box.min()[axis] = quantile(coordinates, tail);
    box.max()[axis] = quantile(coordinates, 1.0 - tail);
  }
  return box;
}

std::uint64_t samplingStride(const ViewSequence& views, std::size_t samples) {
  std::uint64_t pixels = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Projection& projection = views.header(i).projection;
    pixels += static_cast<std::uint64_t>(imageWidth(projection)) *
              static_cast<std::uint64_t>(imageHeight(projection));
  }
  return std::max<std::uint64_t>(1, (pixels + samples - 1) / samples);
}

void check(const SummaryOptions& options) {
  if (!(options.tail >= 0 && options.tail < 0.5)) throw InvalidArgument("tail", "must lie in [0, 0.5)");
  if (options.samples == 0) throw InvalidArgument("samples", "must be above 0");
}

}  // namespace

double ViewsSummary::coverage() const {
  return pixels == 0 ? 0.0 : static_cast<double>(valid_pixels) / static_cast<double>(pixels);
}

ViewsSummary summarise(const ViewSequence& views, const SummaryOptions& options, const Progress& progress) {
  check(options);
  const std::uint64_t stride = samplingStride(views, options.samples);
  std::vector<Tally> tallies(views.size());
  ProgressStep step(progress, "reading views", views.size());
  parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tallies[i] = tallyView(views.load(i), stride);
      step.advance();
    }
  });
  ViewsSummary summary;
  Tally all;
  for (std::size_t i = 0; i < views.size(); ++i) {
    all.append(tallies[i]);
    tallies[i] = {};
    summary.cameras.extend(views.header(i).world_from_camera.translation());
  }
  summary.views = views.size();
  summary.views_with_confidence = all.with_confidence, summary.views_with_color = all.with_color;
  summary.pixels = all.pixels, summary.valid_pixels = all.valid;
  summary.depth = spreadOf(std::move(all.depth), options.tail);
  summary.confidence = spreadOf(std::move(all.confidence), options.tail);
  summary.points = boxOf(std::move(all.points), options.tail);
  return summary;
}

}  // namespace vdbfuse
