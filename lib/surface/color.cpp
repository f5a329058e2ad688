// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kVerticesPerTask = 4096;
constexpr std::size_t kViewsPerBatch = 8;
constexpr std::size_t kSamples = 6;
constexpr double kLeastCosine = 0.1;
constexpr double kEdgeWeight =
    0.2;                        // of pixels beside a step in depth: pictures are never aligned to the pixel
constexpr int kAgreement = 30;  // levels from the median, in every channel

struct Sample {
  float weight = 0;
  Rgb8 color{};
};
using Samples = std::array<Sample, kSamples>;  // best first

void add(const Sample& sample, Samples& samples) {
  if (!(sample.weight > samples.back().weight)) return;
  samples.back() = sample;
  for (std::size_t k = kSamples - 1; k > 0 && samples[k].weight > samples[k - 1].weight; --k)
    std::swap(samples[k], samples[k - 1]);
}

// Every picture has one vote: a good view of a mistake is a mistake. The better of two decides.
std::uint8_t median(const Samples& samples, std::size_t channel) {
  constexpr float kTie = 0.01f;
  std::array<std::pair<std::uint8_t, float>, kSamples> values;
  float total = 0;
  for (std::size_t k = 0; k < kSamples; ++k) {
    const float share = samples[k].weight / samples.front().weight;
    values[k] = {samples[k].color[channel], share > 0 ? 1 + kTie * share : 0};
    total += values[k].second;
  }
  std::sort(values.begin(), values.end());
  float below = 0;
  for (const auto& [value, weight] : values) {
    below += weight;
    if (2 * below >= total) return value;
  }
  return values.back().first;
}

std::optional<Rgb8> robustMean(const Samples& samples) {
  if (!(samples.front().weight > 0)) return std::nullopt;
  Rgb8 middle;
  for (std::size_t c = 0; c < 3; ++c) middle[c] = median(samples, c);
  std::array<float, 3> sum{};
  float total = 0;
  for (const Sample& sample : samples) {
    bool agrees = sample.weight > 0;
    for (std::size_t c = 0; c < 3; ++c) agrees &= std::abs(sample.color[c] - middle[c]) <= kAgreement;
    if (!agrees) continue;
    total += sample.weight;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += sample.weight * sample.color[c];
  }
  if (!(total > 0)) return middle;
  Rgb8 mean;
  for (std::size_t c = 0; c < 3; ++c) mean[c] = static_cast<std::uint8_t>(std::lround(sum[c] / total));
  return mean;
}

Rgb8 interpolated(const Image<Rgb8>& picture, double x, double y) {
  x = std::clamp<double>(x, 0, picture.width() - 1), y = std::clamp<double>(y, 0, picture.height() - 1);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, picture.width() - 1), bottom = std::min(top + 1, picture.height() - 1);
  const double u = x - left, v = y - top;
  Rgb8 color;
  for (std::size_t c = 0; c < 3; ++c) {
    const double upper = (1 - u) * picture(left, top)[c] + u * picture(right, top)[c];
    const double lower = (1 - u) * picture(left, bottom)[c] + u * picture(right, bottom)[c];
    color[c] = static_cast<std::uint8_t>(std::lround((1 - v) * upper + v * lower));
  }
  return color;
}

// A view whose picture is looked up.
class ColorView {
 public:
  ColorView(View view, double tolerance)
      : view_(std::move(view)), tolerance_(tolerance), depth_(view_.projection, view_.world_from_camera) {
    if (view_.color_sensor)
      picture_.emplace(view_.color_sensor->projection, view_.color_sensor->world_from_camera);
  }

  Sample at(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
    const std::optional<PixelDepth> seen = depth_.place(point);
    if (!seen) return {};
    const int x = static_cast<int>(seen->x + 0.5), y = static_cast<int>(seen->y + 0.5);
    if (!agrees(x, y, seen->depth)) return {};
    const Eigen::Vector3d ray =
        view_.world_from_camera.linear() * rayDirection(view_.projection, seen->x, seen->y, seen->depth);
    const double cosine = -normal.dot(ray);
    if (cosine < kLeastCosine) return {};
    const std::optional<Eigen::Vector2d> place = inPicture(point, *seen);
    if (!place) return {};
    const double edge = isBesideEdge(x, y, seen->depth) ? kEdgeWeight : 1;
    const double weight = edge * cosine * cosine / (seen->depth * seen->depth);
    return {static_cast<float>(weight), interpolated(view_.map.color, place->x(), place->y())};
  }

 private:
  bool agrees(int x, int y, double depth) const {
    const float measured = view_.map.depth(x, y);
    return measured != kInvalidDepth && std::abs(measured - depth) <= tolerance_;
  }
  bool isBesideEdge(int x, int y, double depth) const {
    for (const auto& [dx, dy] : {std::pair{-1, 0}, std::pair{1, 0}, std::pair{0, -1}, std::pair{0, 1}}) {
      if (!view_.map.depth.contains(x + dx, y + dy)) return true;
      const float other = view_.map.depth(x + dx, y + dy);
      if (other == kInvalidDepth || std::abs(other - depth) > 3 * tolerance_) return true;
    }
    return false;
  }
  std::optional<Eigen::Vector2d> inPicture(const Eigen::Vector3d& point, const PixelDepth& seen) const {
    if (picture_) {
      const std::optional<PixelDepth> place = picture_->place(point);
      if (!place) return std::nullopt;
      return Eigen::Vector2d(place->x, place->y);
    }
    // The depth sensor's own picture, of another size perhaps: edges coincide, not pixel centres.
    const double sx = static_cast<double>(view_.map.color.width()) / view_.map.depth.width();
    const double sy = static_cast<double>(view_.map.color.height()) / view_.map.depth.height();
    return Eigen::Vector2d((seen.x + 0.5) * sx - 0.5, (seen.y + 0.5) * sy - 0.5);
  }

  View view_;
  double tolerance_;
  Projector depth_;
  std::optional<Projector> picture_;
};

std::vector<ColorView> loadBatch(const ViewSequence& views, std::size_t first, const ColorOptions& options) {
  std::vector<std::optional<ColorView>> loaded(std::min(kViewsPerBatch, views.size() - first));
  parallelFor(loaded.size(), 1, [&](std::size_t i, std::size_t) {
    View view = views.load(first + i);
    if (!view.map.color.empty()) loaded[i].emplace(std::move(view), options.tolerance);
  });
  std::vector<ColorView> result;
  for (auto& view : loaded) {
    if (view) result.push_back(std::move(*view));
  }
  return result;
}

// Neighbours of each vertex: those of v are others[first[v]] … others[first[v + 1] − 1], with repeats.
struct Neighbours {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> others;
};

Neighbours neighboursOf(const TriangleMesh& mesh) {
  Neighbours result{std::vector<std::size_t>(mesh.vertices.size() + 1), {}};
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) result.first[v + 1] += 2;
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) result.first[v + 1] += result.first[v];
  result.others.resize(result.first.back());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      result.others[next[t[k]]++] = t[(k + 1) % 3];
      result.others[next[t[k]]++] = t[(k + 2) % 3];
    }
  }
  return result;
}

// Colours spread from vertex to vertex, a ring at a time.
void spread(std::vector<bool> known, TriangleMesh& mesh) {
  const Neighbours neighbours = neighboursOf(mesh);
  std::vector<std::uint32_t> front;
  for (std::uint32_t v = 0; v < known.size(); ++v) {
    if (known[v]) front.push_back(v);
  }
  while (!front.empty()) {
    std::vector<std::uint32_t> ring;
    for (const std::uint32_t v : front) {
      for (std::size_t k = neighbours.first[v]; k < neighbours.first[v + 1]; ++k) {
        if (!known[neighbours.others[k]]) ring.push_back(neighbours.others[k]);
      }
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    for (const std::uint32_t v : ring) {
      std::array<unsigned, 3> sum{};
      unsigned count = 0;
      for (std::size_t k = neighbours.first[v]; k < neighbours.first[v + 1]; ++k) {
        const std::uint32_t other = neighbours.others[k];
        if (!known[other]) continue;
        ++count;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += mesh.colors[other][c];
      }
      for (std::size_t c = 0; c < 3; ++c) mesh.colors[v][c] = static_cast<std::uint8_t>(sum[c] / count);
    }
    for (const std::uint32_t v : ring) known[v] = true;
    front = std::move(ring);
  }
}

}  // namespace

ColorReport colorVertices(const ViewSequence& views, const ColorOptions& options, TriangleMesh& mesh,
                          const Progress& progress) {
  if (!(options.tolerance > 0)) throw InvalidArgument("tolerance", "must be positive");
  if (mesh.normals.size() != mesh.vertices.size()) throw InvalidArgument("mesh", "has no normals");
  ColorReport report;
  std::vector<Samples> samples(mesh.vertices.size());
  ProgressStep step(progress, "colour", views.size());
  for (std::size_t first = 0; first < views.size(); first += kViewsPerBatch) {
    const std::vector<ColorView> batch = loadBatch(views, first, options);
    report.views += batch.size();
    parallelFor(samples.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
      for (const ColorView& view : batch) {
        for (std::size_t v = begin; v < end; ++v)
          add(view.at(mesh.vertices[v].cast<double>(), mesh.normals[v].cast<double>()), samples[v]);
      }
    });
    step.advance(std::min(kViewsPerBatch, views.size() - first));
  }
  if (report.views == 0) return report;
  constexpr Rgb8 kGrey{128, 128, 128};
  mesh.colors.assign(mesh.vertices.size(), kGrey);
  std::vector<bool> known(mesh.vertices.size());
  for (std::size_t v = 0; v < samples.size(); ++v) {
    const std::optional<Rgb8> color = robustMean(samples[v]);
    if (!color) continue;
    mesh.colors[v] = *color;
    known[v] = true;
    ++report.colored;
  }
  if (report.colored < mesh.vertices.size()) spread(std::move(known), mesh);
  return report;
}

}  // namespace vdbfuse
