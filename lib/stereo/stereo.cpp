// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/stereo.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stereo/cross_view.h"
#include "stereo/match_view.h"
#include "stereo/matching_constants.h"
#include "stereo/other_voters.h"
#include "stereo/paper.h"
#include "stereo/pyramid_store.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using namespace stereo;

// What is known before the first picture is loaded.
struct Plan {
  std::vector<PhotographHeader> headers;
  std::vector<DepthInterval> depths;
  std::vector<std::vector<std::size_t>> partners;
};

DepthInterval chosenDepths(const Plan& plan, std::size_t index, const StereoOptions& options) {
  const bool is_given = options.min_depth > 0 && options.max_depth > 0;
  DepthInterval depths = is_given ? DepthInterval{} : depthsOf(plan.headers, index, options.domain);
  if (options.min_depth > 0) depths.near = options.min_depth;
  if (options.max_depth > 0) depths.far = options.max_depth;
  if (!(depths.far > depths.near))
    throw InvalidArgument("depths", "nothing is left between " + std::to_string(depths.near) + " and " +
                                        std::to_string(depths.far) + " for photograph " +
                                        plan.headers[index].name);
  return depths;
}

Plan planFor(const PhotographSequence& photographs, const StereoOptions& options) {
  Plan plan;
  for (std::size_t i = 0; i < photographs.size(); ++i) plan.headers.push_back(photographs.header(i));
  for (std::size_t i = 0; i < photographs.size(); ++i) plan.depths.push_back(chosenDepths(plan, i, options));
  plan.partners = choosePartners(plan.headers, plan.depths, options.partners);
  return plan;
}

MatchInput matchInput(const Plan& plan, std::size_t index, PyramidStore& store) {
  MatchInput input;
  const auto posed = [&](std::size_t i) {
    return PosedPyramid{store.get(i), plan.headers[i].world_from_camera};
  };
  input.reference = posed(index);
  for (const std::size_t partner : plan.partners[index]) input.partners.push_back(posed(partner));
  input.depths = plan.depths[index];
  return input;
}

// Everything of a view but its depths.
StereoView emptyView(const Plan& plan, std::size_t index, Photograph photograph) {
  StereoView result;
  static_cast<ViewHeader&>(result.view) = {photograph.name, photograph.camera, photograph.world_from_camera};
  result.view.map.mask = std::move(photograph.mask);
  result.view.map.color = std::move(photograph.color);
  if (result.view.map.color.empty()) {
    result.view.map.color = Image<Rgb8>(photograph.camera.width, photograph.camera.height);
    std::transform(photograph.brightness.begin(), photograph.brightness.end(), result.view.map.color.begin(),
                   [](float b) {
                     const auto grey =
                         static_cast<std::uint8_t>(std::lround(255 * std::clamp(b, 0.0F, 1.0F)));
                     return Rgb8{grey, grey, grey};
                   });
  }
  result.partners = plan.partners[index];
  result.depths = plan.depths[index];
  return result;
}

// Spread of the votes around their depth, in pixels of the widest partner: a median, because the few that
// were wrong do not matter; 1.48 makes a standard deviation of it.
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

void storeDepths(const std::vector<DepthLayer>& layers, float full_score, float pixel, double min_confidence,
                 StereoView& view) {
  const DepthLayer& best = layers.front();
  DepthMap& map = view.view.map;
  const int width = best.score.width(), height = best.score.height();
  map.depth = map.confidence = view.second_best = Image<float>(width, height);
  view.voters = best.voters;
  for (std::size_t i = 0; i < best.score.size(); ++i) {
    const float w = best.inverse_depth.data()[i];
    const float confidence =
        std::clamp((best.score.data()[i] + best.support.data()[i]) / full_score, 0.0F, 1.0F);
    if (!(w > 0) || static_cast<double>(confidence) < min_confidence) {
      view.voters.data()[i] = 0;
      continue;
    }
    map.depth.data()[i] = 1 / w;
    map.confidence.data()[i] = confidence;
    view.second_best.data()[i] = std::min(confidence, best.second.data()[i] / full_score);
  }
  view.matching_error_px = matchingError(best, pixel);
  view.noise = NoiseLaw{0, 0, view.matching_error_px * static_cast<double>(pixel)};
}

class FastStereo {
 public:
  FastStereo(const PhotographSequence& photographs, const StereoOptions& options, const Progress& progress)
      : photographs_(photographs),
        options_(options),
        progress_(progress),
        plan_(planFor(photographs, options)),
        store_(photographs, options) {}

  StereoResult run() {
    StepTimer timer;
    timer.start("match");
    match();
    if (options_.cross_check == StereoOptions::CrossCheck::On && options_.surface_sweeps > 0) {
      timer.start("cross-check");
      // Ever nearer: what other views say has brought the surface close.
      for (const int reach : {4, 3, 2}) crossCheck(reach);
    }
    timer.start("write");
    StereoResult result;
    for (std::size_t i = 0; i < plan_.headers.size(); ++i) {
      StereoView view = emptyView(plan_, i, photographs_.load(i));
      const auto full = static_cast<float>(plan_.partners[i].size()) +
                        (others_.empty() ? 0.0F : kOtherViewsWeight * static_cast<float>(others_[i].size()));
      storeDepths(layers_[i], full, pixels_[i], options_.min_confidence, view);
      result.views.push_back(std::move(view));
    }
    result.steps = timer.finish();
    return result;
  }

 private:
  void match() {
    ProgressStep step(progress_, "matching", plan_.headers.size());
    for (std::size_t i = 0; i < plan_.headers.size(); ++i) {
      const MatchInput input = matchInput(plan_, i, store_);
      layers_.push_back(matchView(input, options_));
      pixels_.push_back(inverseDepthOfPixel(input, 0));
      step.advance();
    }
  }

  void crossCheck(int reach) {
    if (others_.empty())
      others_ =
          choosePartners(plan_.headers, plan_.depths, {.count = 6, .min_angle_deg = 0, .max_angle_deg = 60});
    ProgressStep step(progress_, "cross-checking", plan_.headers.size());
    std::vector<std::vector<DepthLayer>> checked;
    for (std::size_t i = 0; i < plan_.headers.size(); ++i) {
      const PhotographHeader& own = plan_.headers[i];
      std::vector<Testimony> testimonies(others_[i].size());
      parallelFor(testimonies.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const std::size_t j = others_[i][k];
          testimonies[k] =
              seenFrom({&layers_[j].front(), plan_.headers[j].camera, plan_.headers[j].world_from_camera,
                        static_cast<float>(plan_.partners[j].size())},
                       own.camera, own.world_from_camera, 2 * pixels_[i]);
        }
      });
      checked.push_back(layers_[i]);
      checked.back().front() =
          crossChecked(matchInput(plan_, i, store_), options_, layers_[i].front(), testimonies, reach);
      step.advance();
    }
    layers_ = std::move(checked);
  }

  const PhotographSequence& photographs_;
  const StereoOptions& options_;
  const Progress& progress_;
  Plan plan_;
  PyramidStore store_;
  std::vector<std::vector<DepthLayer>> layers_;  // of each photograph, the best first
  std::vector<float> pixels_;                    // inverse depth of a pixel
  std::vector<std::vector<std::size_t>> others_;
};

StereoResult paperStereo(const PhotographSequence& photographs, const StereoOptions& options,
                         const Progress& progress) {
  const Plan plan = planFor(photographs, options);
  StepTimer timer;
  timer.start("match");
  StereoResult result;
  ProgressStep step(progress, "matching", plan.headers.size());
  for (std::size_t i = 0; i < plan.headers.size(); ++i) {
    Photograph reference = photographs.load(i);
    std::vector<Photograph> partners;
    for (const std::size_t partner : plan.partners[i]) partners.push_back(photographs.load(partner));
    PaperOptions paper;
    paper.window_px = options.window_px, paper.hypotheses = options.hypotheses;
    paper.min_confidence = options.min_confidence;
    StereoView found = paperDepthMap(reference, partners, plan.depths[i], paper);
    StereoView view = emptyView(plan, i, std::move(reference));
    view.view.map.depth = std::move(found.view.map.depth);
    view.view.map.confidence = std::move(found.view.map.confidence);
    view.view.map.alternatives = std::move(found.view.map.alternatives);
    view.second_best = std::move(found.second_best), view.voters = std::move(found.voters);
    result.views.push_back(std::move(view));
    step.advance();
  }
  result.steps = timer.finish();
  return result;
}

}  // namespace

StereoResult computeDepthMaps(const PhotographSequence& photographs, const StereoOptions& options,
                              const Progress& progress) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
  if (photographs.size() < 2)
    throw InvalidArgument("photographs",
                          "expected at least two, found " + std::to_string(photographs.size()));
  if (options.mode == StereoOptions::Mode::Paper) return paperStereo(photographs, options, progress);
  return FastStereo(photographs, options, progress).run();
}

}  // namespace vdbfuse
