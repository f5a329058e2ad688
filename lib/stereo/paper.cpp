// SPDX-License-Identifier: Apache-2.0
#include "stereo/paper.h"

#include <algorithm>

#include "stereo/paper_curve.h"
#include "stereo/paper_votes.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::stereo {
namespace {

using paper::Mode;
using paper::RayImage;
using paper::RaySteps;
using paper::Vote;

StereoView emptyViewOf(const Photograph& reference, const DepthInterval& depths, int hypotheses) {
  const int width = reference.camera.width, height = reference.camera.height;
  StereoView result;
  result.view.name = reference.name;
  result.view.projection = reference.camera;
  result.view.world_from_camera = reference.world_from_camera;
  result.view.map.depth = Image<float>(width, height, kInvalidDepth);
  result.view.map.confidence = Image<float>(width, height);
  result.view.map.mask = reference.mask;
  for (int i = 1; i < hypotheses; ++i)
    result.view.map.alternatives.push_back(
        {Image<float>(width, height, kInvalidDepth), Image<float>(width, height)});
  result.second_best = Image<float>(width, height);
  result.voters = Image<std::uint8_t>(width, height);
  result.depths = depths;
  return result;
}

// Matches one photograph, pixel by pixel.
class PaperMatcher {
 public:
  PaperMatcher(const Photograph& reference, const std::vector<Photograph>& partners,
               const DepthInterval& depths, const PaperOptions& options)
      : reference_(reference),
        partners_(partners),
        options_(options),
        steps_(paper::raySteps(reference, {partners.begin(), partners.end()}, depths, options.step_px)) {
    for (const Photograph& partner : partners) rays_.push_back(paper::rayImage(reference, partner));
  }

  void match(int x, int y, StereoView& result) const {
    const auto window = paper::windowAt(reference_, x, y, options_.window_px / 2);
    if (!window) return;
    std::vector<std::vector<double>> curves;  // S_j
    std::vector<Vote> votes;                  // d_jk
    for (std::size_t j = 0; j < partners_.size(); ++j) {
      curves.push_back(paper::correlationCurve(*window, partners_[j], rays_[j], steps_));
      const std::vector<Vote> maxima = paper::localMaxima(curves.back(), options_.threshold, j);
      votes.insert(votes.end(), maxima.begin(), maxima.end());
    }
    const bool by_votes = options_.score == PaperOptions::Score::Votes;
    std::vector<Mode> modes = by_votes ? paper::modesOf(votes) : paper::modesOfMean(curves);
    const double full = by_votes ? static_cast<double>(partners_.size()) : 1;
    for (Mode& mode : modes) mode.score = std::min(mode.score / full, 1.0);
    if (modes.empty() || modes.front().score < options_.min_confidence) return;
    result.voters(x, y) = static_cast<std::uint8_t>(paper::votersAt(votes, modes.front().step));
    write(modes, x, y, result);
  }

 private:
  // argmax C(d), and what comes after it.
  void write(const std::vector<Mode>& modes, int x, int y, StereoView& result) const {
    DepthMap& map = result.view.map;
    map.depth(x, y) = depthOf(modes.front());
    map.confidence(x, y) = static_cast<float>(modes.front().score);
    if (modes.size() > 1) result.second_best(x, y) = static_cast<float>(modes[1].score);
    const std::size_t kept = std::min(modes.size(), map.alternatives.size() + 1);
    double total = 0;
    for (std::size_t i = 0; i < kept; ++i) total += modes[i].score;
    for (std::size_t i = 1; i < kept; ++i) {
      map.alternatives[i - 1].depth(x, y) = depthOf(modes[i]);
      map.alternatives[i - 1].share(x, y) = static_cast<float>(modes[i].score / total);
    }
  }

  float depthOf(const Mode& mode) const { return static_cast<float>(1 / steps_.inverseDepth(mode.step)); }

  const Photograph& reference_;
  const std::vector<Photograph>& partners_;
  const PaperOptions& options_;
  RaySteps steps_;
  std::vector<RayImage> rays_;
};

}  // namespace

StereoView paperDepthMap(const Photograph& reference, const std::vector<Photograph>& partners,
                         const DepthInterval& depths, const PaperOptions& options,
                         const std::function<void(std::size_t rows)>& done) {
  StereoView result = emptyViewOf(reference, depths, options.hypotheses);
  const PaperMatcher matcher(reference, partners, depths, options);
  const auto height = static_cast<std::size_t>(reference.camera.height);
  parallelFor(height, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      for (int x = 0; x < reference.camera.width; ++x) matcher.match(x, static_cast<int>(y), result);
    if (done) done(end - begin);
  });
  return result;
}

}  // namespace vdbfuse::stereo
