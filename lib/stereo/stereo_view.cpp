// SPDX-License-Identifier: Apache-2.0
#include "stereo/stereo_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stereo/matching_constants.h"

namespace vdbfuse::stereo {
namespace {

Rgb8 grey(float brightness) {
  const std::uint8_t level = greyLevel(brightness);
  return {level, level, level};
}

// Spread of the votes around their depth, in pixels of the widest partner: of all pixels the median, because
// those that are wrong should not matter.
double matchingError(const DepthLayer& layer, float inverse_depth_of_pixel) {
  std::vector<float> spreads;
  for (std::size_t i = 0; i < layer.spread2.size(); ++i) {
    if (layer.voters.data()[i] >= 2 && layer.inverse_depth.data()[i] > 0)
      spreads.push_back(std::sqrt(layer.spread2.data()[i]));
  }
  if (spreads.empty()) return 0;
  const auto middle = spreads.begin() + static_cast<std::ptrdiff_t>(spreads.size() / 2);
  std::nth_element(spreads.begin(), middle, spreads.end());
  return static_cast<double>(*middle / inverse_depth_of_pixel);
}

// A little beyond the box: it is where one looks, not where the surface ends to the last digit.
void leaveOutBeyond(const Box& box, View& view) {
  const double slack = 0.01 * box.diagonal().norm();
  const Box wanted(box.min().array() - slack, box.max().array() + slack);
  for (int y = 0; y < view.map.depth.height(); ++y) {
    for (int x = 0; x < view.map.depth.width(); ++x) {
      float& depth = view.map.depth(x, y);
      if (depth > 0 && !wanted.contains(worldPoint(view, x, y))) depth = kInvalidDepth;
    }
  }
}

// What else a pixel may have seen, the best first: no two nearer to each other than three sigma of a vote.
std::vector<std::pair<float, float>> otherDepths(const ViewMatch& match, std::size_t i, std::size_t most,
                                                 float apart) {
  std::vector<std::pair<float, float>> found{
      {match.best.inverse_depth.data()[i], match.best.score.data()[i]}};
  for (const DepthLayer& mode : match.modes) {
    const float w = mode.inverse_depth.data()[i], score = mode.score.data()[i];
    const auto is_near = [&](const auto& other) { return std::abs(other.first - w) < apart; };
    if (!(w > 0) || !(score > 0) || std::any_of(found.begin(), found.end(), is_near)) continue;
    if (found.size() <= most) found.emplace_back(w, score);
  }
  return found;
}

void storeAlternatives(const ViewMatch& match, int hypotheses, float pixel, DepthMap& map) {
  const auto others = static_cast<std::size_t>(hypotheses) - 1;
  const Image<float> none(map.depth.width(), map.depth.height());
  map.alternatives.assign(others, {none, none});
  const float apart = 3 * static_cast<float>(kVoteSigma) * kExactStep * pixel;
  for (std::size_t i = 0; i < map.depth.size(); ++i) {
    if (!(map.depth.data()[i] > 0)) continue;
    const auto found = otherDepths(match, i, others, apart);
    float sum = 0;
    for (const auto& depth : found) sum += depth.second;
    for (std::size_t k = 1; k < found.size() && sum > 0; ++k) {
      map.alternatives[k - 1].depth.data()[i] = 1 / found[k].first;
      map.alternatives[k - 1].share.data()[i] = std::min(found[k].second / sum, 0.99F);
    }
  }
}

}  // namespace

StereoView viewWithoutDepths(const StereoPlan& plan, std::size_t index, Photograph photograph) {
  StereoView result;
  static_cast<ViewHeader&>(result.view) = {photograph.name, photograph.camera, photograph.world_from_camera};
  result.view.map.mask = std::move(photograph.mask);
  result.view.map.color = std::move(photograph.color);
  if (result.view.map.color.empty()) {
    result.view.map.color = Image<Rgb8>(photograph.camera.width, photograph.camera.height);
    std::transform(photograph.brightness.begin(), photograph.brightness.end(), result.view.map.color.begin(),
                   grey);
  }
  result.partners = plan.partners[index];
  result.depths = plan.depths[index];
  return result;
}

void storeDepths(const ViewMatch& match, float full_score, float pixel, const StereoOptions& options,
                 StereoView& view) {
  const DepthLayer& best = match.best;
  DepthMap& map = view.view.map;
  const int width = best.score.width(), height = best.score.height();
  map.depth = map.confidence = view.second_best = Image<float>(width, height);
  view.voters = best.voters;
  std::transform(best.inverse_depth.begin(), best.inverse_depth.end(), map.depth.begin(),
                 [](float w) { return w > 0 ? 1 / w : kInvalidDepth; });
  if (options.domain) leaveOutBeyond(*options.domain, view.view);
  for (std::size_t i = 0; i < best.score.size(); ++i) {
    const float confidence =
        std::clamp((best.score.data()[i] + best.support.data()[i]) / full_score, 0.0F, 1.0F);
    if (static_cast<double>(confidence) < options.min_confidence) map.depth.data()[i] = kInvalidDepth;
    if (map.depth.data()[i] == kInvalidDepth) {
      view.voters.data()[i] = 0;
      continue;
    }
    map.confidence.data()[i] = confidence;
    view.second_best.data()[i] = std::min(confidence, best.second.data()[i] / full_score);
  }
  if (options.hypotheses > 1) storeAlternatives(match, options.hypotheses, pixel, view.view.map);
  view.matching_error_px = matchingError(best, pixel);
  view.noise = NoiseLaw{0, 0, view.matching_error_px * static_cast<double>(pixel)};
}

}  // namespace vdbfuse::stereo
