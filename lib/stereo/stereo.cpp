// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/stereo.h"

#include <algorithm>
#include <array>
#include <utility>

#include "stereo/cross_view.h"
#include "stereo/match_view.h"
#include "stereo/other_voters.h"
#include "stereo/paper.h"
#include "stereo/pyramid_store.h"
#include "stereo/stereo_view.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using namespace stereo;

MatchInput matchInput(const StereoPlan& plan, std::size_t index, PyramidStore& store) {
  MatchInput input;
  const auto posed = [&](std::size_t i) {
    return PosedPyramid{store.get(i), plan.headers[i].world_from_camera};
  };
  input.reference = posed(index);
  for (const std::size_t partner : plan.partners[index]) input.partners.push_back(posed(partner));
  input.depths = plan.depths[index];
  return input;
}

class FastStereo {
 public:
  FastStereo(const PhotographSequence& photographs, const StereoOptions& options, const Progress& progress)
      : photographs_(photographs),
        options_(options),
        progress_(progress),
        plan_(stereoPlan(photographs, options)),
        store_(photographs, options) {}

  StereoResult run() {
    StepTimer timer;
    timer.start("match");
    match();
    if (options_.cross_check == StereoOptions::CrossCheck::On && options_.surface_sweeps > 0) {
      timer.start("cross-check");
      crossCheck();
    }
    timer.start("write");
    StereoResult result;
    for (std::size_t i = 0; i < plan_.headers.size(); ++i) {
      StereoView view = viewWithoutDepths(plan_, i, photographs_.load(i));
      const auto full = static_cast<float>(plan_.partners[i].size()) +
                        (others_.empty() ? 0.0F : kOtherViewsWeight * static_cast<float>(others_[i].size()));
      storeDepths(matches_[i], full, pixels_[i], options_, view);
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
      matches_.push_back(matchView(input, options_));
      pixels_.push_back(inverseDepthOfPixel(input, 0));
      step.advance();
    }
  }

  void crossCheck() {
    others_ =
        choosePartners(plan_.headers, plan_.depths, {.count = 6, .min_angle_deg = 0, .max_angle_deg = 60});
    // Ever nearer: what other views say has brought the surface close.
    constexpr std::array kReaches = {4, 3, 2};
    ProgressStep step(progress_, "cross-checking", kReaches.size() * plan_.headers.size());
    for (const int reach : kReaches) crossCheck(reach, step);
  }

  void crossCheck(int reach, ProgressStep& step) {
    std::vector<DepthLayer> checked;
    for (std::size_t i = 0; i < plan_.headers.size(); ++i) {
      const PhotographHeader& own = plan_.headers[i];
      std::vector<Testimony> testimonies(others_[i].size());
      parallelFor(testimonies.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const std::size_t j = others_[i][k];
          testimonies[k] =
              seenFrom({&matches_[j].best, plan_.headers[j].camera, plan_.headers[j].world_from_camera,
                        static_cast<float>(plan_.partners[j].size())},
                       own.camera, own.world_from_camera, 2 * pixels_[i]);
        }
      });
      checked.push_back(
          crossChecked(matchInput(plan_, i, store_), options_, matches_[i].best, testimonies, reach));
      step.advance();
    }
    for (std::size_t i = 0; i < checked.size(); ++i) matches_[i].best = std::move(checked[i]);
  }

  const PhotographSequence& photographs_;
  const StereoOptions& options_;
  const Progress& progress_;
  StereoPlan plan_;
  PyramidStore store_;
  std::vector<ViewMatch> matches_;  // of each photograph
  std::vector<float> pixels_;       // inverse depth of a pixel
  std::vector<std::vector<std::size_t>> others_;
};

StereoResult paperStereo(const PhotographSequence& photographs, const StereoOptions& options,
                         const Progress& progress) {
  const StereoPlan plan = stereoPlan(photographs, options);
  StepTimer timer;
  timer.start("match");
  StereoResult result;
  std::size_t rows = 0;
  for (const PhotographHeader& header : plan.headers) rows += static_cast<std::size_t>(header.camera.height);
  ProgressStep step(progress, "matching", rows);
  for (std::size_t i = 0; i < plan.headers.size(); ++i) {
    Photograph reference = photographs.load(i);
    std::vector<Photograph> partners;
    for (const std::size_t partner : plan.partners[i]) partners.push_back(photographs.load(partner));
    PaperOptions paper;
    paper.window_px = options.window_px, paper.hypotheses = options.hypotheses;
    paper.min_confidence = options.min_confidence;
    StereoView found = paperDepthMap(reference, partners, plan.depths[i], paper,
                                     [&](std::size_t done) { step.advance(done); });
    StereoView view = viewWithoutDepths(plan, i, std::move(reference));
    view.view.map.depth = std::move(found.view.map.depth);
    view.view.map.confidence = std::move(found.view.map.confidence);
    view.view.map.alternatives = std::move(found.view.map.alternatives);
    view.second_best = std::move(found.second_best), view.voters = std::move(found.voters);
    result.views.push_back(std::move(view));
  }
  result.steps = timer.finish();
  return result;
}

}  // namespace

std::optional<NoiseLaw> medianNoise(const StereoResult& result) {
  std::vector<double> quadratic;
  for (const StereoView& view : result.views)
    if (view.noise.quadratic > 0) quadratic.push_back(view.noise.quadratic);
  if (quadratic.empty()) return std::nullopt;
  const auto middle = quadratic.begin() + static_cast<std::ptrdiff_t>(quadratic.size() / 2);
  std::nth_element(quadratic.begin(), middle, quadratic.end());
  return NoiseLaw{0, 0, *middle};
}

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
