// SPDX-License-Identifier: Apache-2.0
#include "stereo_score.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbfuse::benchmark {
namespace {

using Eigen::Vector3d;
using Kind = CountedPixels::Kind;

constexpr int kReach = 3;  // of the window
constexpr double kStep = 0.02, kPlain = 3.0;

Vector3d pointAt(const SyntheticView& view, int x, int y, double depth) {
  return view.view.world_from_camera * unproject(view.view.projection, x, y, depth);
}

std::optional<PixelDepth> seenIn(const SyntheticView& view, const Vector3d& point) {
  return project(view.view.projection, view.view.world_from_camera.inverse() * point);
}

// Whether nothing lies before the point: neither of the four true depths around it.
bool isVisible(const SyntheticView& view, const Vector3d& point) {
  constexpr double kTolerance = 0.003;
  const auto seen = seenIn(view, point);
  if (!seen) return false;
  const int x = static_cast<int>(std::floor(seen->x)), y = static_cast<int>(std::floor(seen->y));
  if (!view.true_depth.contains(x, y) || !view.true_depth.contains(x + 1, y + 1)) return false;
  for (int c = 0; c < 4; ++c) {
    const float depth = view.true_depth(x + (c & 1), y + (c >> 1));
    if (depth == kInvalidDepth || seen->depth < depth + kTolerance) return true;
  }
  return false;
}

// Whether a neighbour to the right or below sees something else.
bool isStep(const SyntheticView& view, int x, int y) {
  for (const auto& [u, v] : {std::pair{x + 1, y}, std::pair{x, y + 1}}) {
    if (!view.object.contains(u, v)) continue;
    if (view.object(x, y) != view.object(u, v)) return true;
    if (std::abs(view.true_depth(x, y) - view.true_depth(u, v)) > kStep) return true;
  }
  return false;
}

// 1 where the window around a pixel holds a step.
Image<std::uint8_t> edges(const SyntheticView& view) {
  Image<std::uint8_t> near(view.object.width(), view.object.height());
  for (int y = 0; y < near.height(); ++y)
    for (int x = 0; x < near.width(); ++x) {
      if (!isStep(view, x, y)) continue;
      for (int v = y - kReach; v <= y + kReach + 1; ++v)
        for (int u = x - kReach; u <= x + kReach + 1; ++u)
          if (near.contains(u, v)) near(u, v) = 1;
    }
  return near;
}

// Standard deviation, in grey levels, of what the window sees of the object.
double contrast(const SyntheticView& view, const Image<float>& brightness, int x, int y) {
  double sum = 0, squares = 0, count = 0;
  for (int v = std::max(0, y - kReach); v <= std::min(brightness.height() - 1, y + kReach); ++v)
    for (int u = std::max(0, x - kReach); u <= std::min(brightness.width() - 1, x + kReach); ++u) {
      if (!view.object(u, v)) continue;
      const double b = 255 * brightness(u, v);
      sum += b, squares += b * b, count += 1;
    }
  return std::sqrt(std::max(0.0, squares / count - sum / count * (sum / count)));
}

}  // namespace

StereoScan renderStereo(const SyntheticScan& scan) {
  StereoScan result{renderAll(scan), {}};
  std::vector<Photograph> photographs;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Image<Rgb8>& color = result.views[i].view.map.color;
    photographs.push_back({scan.photographHeader(i), brightnessOf(color), color, {}});
  }
  result.photographs = PhotographSequence::fromPhotographs(std::move(photographs));
  return result;
}

CountedPixels countedPixels(const StereoScan& scan, std::size_t index,
                            const std::vector<std::size_t>& partners) {
  const SyntheticView& view = scan.views[index];
  const Image<float> brightness = brightnessOf(view.view.map.color);
  const Image<std::uint8_t> edge = edges(view);
  CountedPixels result{{brightness.width(), brightness.height(), Kind::Background},
                       {brightness.width(), brightness.height()}};
  for (int y = 0; y < brightness.height(); ++y)
    for (int x = 0; x < brightness.width(); ++x) {
      if (!view.object(x, y)) continue;
      const Vector3d point = pointAt(view, x, y, view.true_depth(x, y));
      const auto seen = std::count_if(partners.begin(), partners.end(),
                                      [&](std::size_t p) { return isVisible(scan.views[p], point); });
      result.seen_by(x, y) = static_cast<std::uint8_t>(seen);
      result.kind(x, y) = contrast(view, brightness, x, y) < kPlain ? Kind::Plain
                          : seen == 0                               ? Kind::Unseen
                          : seen == 1 && partners.size() > 1        ? Kind::SeenOnce
                          : edge(x, y)                              ? Kind::Edge
                                                                    : Kind::Inside;
    }
  return result;
}

PixelError pixelError(const StereoScan& scan, std::size_t index, const std::vector<std::size_t>& partners,
                      int x, int y, double depth) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const SyntheticView& view = scan.views[index];
  const double truth = view.true_depth(x, y);
  std::vector<double> errors;
  double most_moved = -1, widest = kNever;
  for (const std::size_t p : partners) {
    const auto at = [&](double d) { return seenIn(scan.views[p], pointAt(view, x, y, d)); };
    const auto expected = at(truth), further = at(1.001 * truth), found = at(depth);
    if (!expected || !further) continue;
    const double error = found ? std::hypot(found->x - expected->x, found->y - expected->y) : kNever;
    const double moved = std::hypot(further->x - expected->x, further->y - expected->y);
    if (moved > most_moved) most_moved = moved, widest = error;
    errors.push_back(error);
  }
  if (errors.empty()) return {kNever, kNever};
  std::sort(errors.begin(), errors.end());
  return {0.5 * (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]), widest};
}

std::size_t StereoScore::object() const {
  std::size_t sum = 0;
  for (std::size_t k = 1; k < 6; ++k) sum += pixels[k];
  return sum;
}

StereoScore& operator+=(StereoScore& sum, const StereoScore& other) {
  for (std::size_t k = 0; k < 6; ++k) sum.pixels[k] += other.pixels[k];
  sum.invented += other.invented;
  sum.edge.insert(sum.edge.end(), other.edge.begin(), other.edge.end());
  sum.inside.insert(sum.inside.end(), other.inside.begin(), other.inside.end());
  return sum;
}

StereoScore score(const StereoScan& scan, std::size_t index, const std::vector<std::size_t>& partners,
                  const Image<float>& depth) {
  const CountedPixels counted = countedPixels(scan, index, partners);
  StereoScore result;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const Kind kind = counted.kind(x, y);
      ++result.pixels[static_cast<std::size_t>(kind)];
      if (depth(x, y) == kInvalidDepth) continue;
      if (kind == Kind::Background) ++result.invented;
      if (!counted.counts(x, y)) continue;
      (kind == Kind::Edge ? result.edge : result.inside)
          .push_back(pixelError(scan, index, partners, x, y, depth(x, y)));
    }
  return result;
}

}  // namespace vdbfuse::benchmark
