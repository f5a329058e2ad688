// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/view_graph.h"

#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <numbers>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Feature = Eigen::Matrix<float, 6, 1>;

// More than this many nearest views are never looked at.
constexpr std::size_t kMaxOrder = 1024;

Feature poseFeature(const ViewHeader& view, double typical_depth) {
  Feature f;
  f.head<3>() = view.world_from_camera.linear().col(2).cast<float>();
  f.tail<3>() = (view.world_from_camera.translation() / typical_depth).cast<float>();
  return f / std::numbers::sqrt2_v<float>;
}

std::vector<std::vector<std::size_t>> nearestFirst(std::vector<Feature>& features) {
  const std::size_t count = features.size();
  const std::size_t wanted = std::min(count, kMaxOrder);
  const flann::Matrix<float> points(features.front().data(), count, 6);
  flann::Index<flann::L2<float>> index(points, flann::KDTreeSingleIndexParams());
  index.buildIndex();
  std::vector<std::vector<std::size_t>> found;
  std::vector<std::vector<float>> distances;
  flann::SearchParams exact(flann::FLANN_CHECKS_UNLIMITED);
  index.knnSearch(points, found, distances, wanted, exact);
  for (std::size_t i = 0; i < count; ++i) std::erase(found[i], i);
  return found;
}

bool isFarFromAll(const ViewGraph& graph, std::size_t candidate, const std::vector<std::size_t>& chosen,
                  double angle) {
  return std::all_of(chosen.begin(), chosen.end(),
                     [&](std::size_t other) { return graph.angle(candidate, other) >= angle; });
}

std::vector<std::size_t> spreadNeighbours(const ViewGraph& graph, std::size_t view, double min_angle,
                                          std::size_t count) {
  std::vector<std::size_t> chosen;
  for (const std::size_t candidate : graph.byAngle(view)) {
    if (chosen.size() == count) break;
    if (graph.angle(view, candidate) < min_angle) continue;
    if (isFarFromAll(graph, candidate, chosen, min_angle)) chosen.push_back(candidate);
  }
  return chosen;
}

// Views beyond 4 θ add less than 1e-6 each, and come last.
std::vector<double> weightsFor(const ViewGraph& graph, std::size_t views, double theta) {
  std::vector<double> weights(views);
  for (std::size_t i = 0; i < views; ++i) {
    double sum = 1.0;
    for (const std::size_t j : graph.byAngle(i)) {
      const double ratio = graph.angle(i, j) / theta;
      if (ratio > 4) break;
      sum += std::exp(-ratio * ratio);
    }
    weights[i] = 1.0 / sum;
  }
  return weights;
}

}  // namespace

ViewGraph::ViewGraph(const std::vector<const ViewHeader*>& views, double typical_depth) {
  if (!(typical_depth > 0)) throw InvalidArgument("typical_depth", "must be positive");
  if (views.empty()) return;
  for (const ViewHeader* view : views) features_.push_back(poseFeature(*view, typical_depth));
  order_ = nearestFirst(features_);
}

double ViewGraph::angle(std::size_t a, std::size_t b) const {
  return static_cast<double>((features_[a] - features_[b]).norm());
}

std::vector<std::vector<std::size_t>> chooseNeighbours(const ViewGraph& graph, std::size_t views,
                                                       const NeighbourOptions& options) {
  constexpr double kSmallestAngleDeg = 0.01;
  std::vector<std::vector<std::size_t>> result(views);
  for (std::size_t i = 0; i < views; ++i) {
    const std::size_t enough = std::min(options.at_least, views - 1);
    double angle = options.min_angle_deg;
    do {
      result[i] = spreadNeighbours(graph, i, angle * std::numbers::pi / 180, options.count);
      angle = angle > kSmallestAngleDeg ? angle / 2 : -1.0;
    } while (result[i].size() < enough && angle != -1.0);
    if (result[i].size() < enough) result[i] = spreadNeighbours(graph, i, 0.0, options.count);
  }
  return result;
}

std::vector<std::size_t> pathThrough(const ViewGraph& graph, std::size_t views) {
  std::vector<std::size_t> path;
  std::vector<bool> visited(views, false);
  const auto visit = [&](std::size_t view) { path.push_back(view), visited[view] = true; };
  for (std::size_t first = 0; first < views; ++first) {
    if (visited[first]) continue;
    visit(first);
    for (bool stuck = false; !stuck;) {
      const std::vector<std::size_t>& order = graph.byAngle(path.back());
      const auto next =
          std::find_if_not(order.begin(), order.end(), [&](std::size_t v) { return visited[v]; });
      stuck = next == order.end();
      if (!stuck) visit(*next);
    }
  }
  return path;
}

std::vector<double> redundancyWeights(const ViewGraph& graph, std::size_t views) {
  const double enough = std::min(0.9 * static_cast<double>(views), 12.0);
  constexpr int kHalvings = 20;
  double theta = 5.0 * std::numbers::pi / 180;
  std::vector<double> weights(views, 1.0);
  for (int i = 0; i < kHalvings; ++i, theta /= 2) {
    weights = weightsFor(graph, views, theta);
    double sum = 0;
    for (const double w : weights) sum += w;
    if (sum >= enough) break;
  }
  return weights;
}

}  // namespace vdbfuse
