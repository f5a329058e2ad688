// SPDX-License-Identifier: Apache-2.0
#include "mistakes.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse::synth {
namespace {

// Lengths in diagonals of the scene, which are 1.
constexpr double kSilhouetteStep = 0.03;  // a smaller step in depth is a slope
constexpr double kReachBehind = 0.2;      // how far pixels are drawn back where nothing is behind them
constexpr int kPatches = 10;
constexpr double kPatchRadius[] = {6, 22};  // pixels at a width of kReferenceWidth
constexpr double kPatchShift[] = {0.02, 0.25};
constexpr double kSilhouetteWidth = 2;  // pixels at a width of kReferenceWidth
constexpr double kReferenceWidth = 640;

// One image being spoilt; the functions below are applied in the order in which they stand.
struct Spoilt {
  const Image<float>& truth;
  const Image<std::uint8_t>& object;
  const SynthOptions& options;
  Image<float>& depth;
  Image<std::uint8_t>& mistake;
  Random& random;

  double pixelScale() const { return truth.width() / kReferenceWidth; }
  void set(int x, int y, double value, Mistake kind) {
    depth(x, y) = static_cast<float>(value);
    mistake(x, y) = static_cast<std::uint8_t>(kind);
  }
};

void addNoise(Spoilt& s) {
  if (noiseScale(s.options) <= 0) return;
  for (float& d : s.depth) {
    const double n = s.random.normal();
    if (d > 0) d = static_cast<float>(std::max(1e-3, d + noiseSigma(s.options, d) * n));
  }
}

void quantise(Spoilt& s) {
  const double quantum = s.options.quantum;
  if (quantum <= 0) return;
  for (float& d : s.depth) {
    if (d > 0) d = static_cast<float>(std::max(1.0, std::round(d / quantum)) * quantum);
  }
}

// What lies behind a pixel: the furthest depth around it, 0 where the neighbourhood sees nothing; the pixel's
// own depth when nothing is behind.
double depthBehind(const Image<float>& truth, int x, int y, int radius) {
  const double own = truth(x, y);
  double behind = own;
  for (int v = std::max(0, y - radius); v <= std::min(truth.height() - 1, y + radius); ++v)
    for (int u = std::max(0, x - radius); u <= std::min(truth.width() - 1, x + radius); ++u) {
      if (truth(u, v) <= 0) return 0;
      behind = std::max<double>(behind, truth(u, v));
    }
  return behind - own > kSilhouetteStep ? behind : own;
}

void mixSilhouettes(Spoilt& s) {
  const int radius = std::max(1, static_cast<int>(std::lround(kSilhouetteWidth * s.pixelScale())));
  for (int y = 0; y < s.truth.height(); ++y)
    for (int x = 0; x < s.truth.width(); ++x) {
      if (!s.object(x, y) || s.mistake(x, y) != 0) continue;
      double behind = depthBehind(s.truth, x, y, radius);
      if (behind == s.truth(x, y) || s.random.uniform() < 0.5) continue;
      if (behind == 0) behind = s.truth(x, y) + s.random.uniform(0, kReachBehind);
      const double share = s.random.uniform();
      s.set(x, y, (1 - share) * s.depth(x, y) + share * behind, Mistake::Mixed);
    }
}

void shiftPatch(Spoilt& s, int center_x, int center_y, double radius, double shift) {
  const int r = static_cast<int>(radius);
  for (int y = center_y - r; y <= center_y + r; ++y)
    for (int x = center_x - r; x <= center_x + r; ++x) {
      if (!s.truth.contains(x, y) || s.truth(x, y) <= 0) continue;
      if (std::hypot(x - center_x, y - center_y) > radius) continue;
      s.set(x, y, std::max(1e-3, s.depth(x, y) + shift), Mistake::Patch);
    }
}

void shiftPatches(Spoilt& s) {
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < s.object.size(); ++i)
    if (s.object.data()[i]) seen.push_back(i);
  if (seen.empty()) return;
  for (int patch = 0; patch < kPatches; ++patch) {
    const auto center = static_cast<int>(seen[s.random.below(seen.size())]);
    const double radius = s.random.uniform(kPatchRadius[0], kPatchRadius[1]) * s.pixelScale();
    const double size = s.random.uniform(kPatchShift[0], kPatchShift[1]);
    const double shift = s.random.uniform() < 0.5 ? size : -size;
    shiftPatch(s, center % s.truth.width(), center / s.truth.width(), radius, shift);
  }
}

void throwOutliers(Spoilt& s) {
  if (s.options.outliers <= 0) return;
  const DepthRange range = depthRange(s.options);
  for (int y = 0; y < s.truth.height(); ++y)
    for (int x = 0; x < s.truth.width(); ++x) {
      const bool hit = s.random.uniform() < s.options.outliers;
      const double value = s.random.uniform(range.near, range.far);
      if (hit) s.set(x, y, value, Mistake::Outlier);
    }
}

void dropPixels(Spoilt& s) {
  if (s.options.missing <= 0) return;
  for (std::size_t i = 0; i < s.depth.size(); ++i) {
    if (s.random.uniform() >= s.options.missing) continue;
    s.depth.data()[i] = kInvalidDepth;
    s.mistake.data()[i] = 0;
  }
}

// A mistake that noise could have made is none.
void forgiveSmallMistakes(Spoilt& s) {
  for (std::size_t i = 0; i < s.depth.size(); ++i) {
    const double truth = s.truth.data()[i];
    if (truth <= 0 || s.mistake.data()[i] == 0) continue;
    if (std::abs(s.depth.data()[i] - truth) <= 3 * noiseSigma(s.options, truth)) s.mistake.data()[i] = 0;
  }
}

// Logistic of a normal variable, so that no value occurs twice and none lies at the ends of (0, 1).
struct ConfidenceModel {
  double right_mean, wrong_mean, deviation;
  float draw(Random& random, bool wrong) const {
    const double x = (wrong ? wrong_mean : right_mean) + deviation * random.normal();
    return static_cast<float>(1 / (1 + std::exp(-x)));
  }
};

Image<float> drawConfidence(const Spoilt& s) {
  if (s.options.confidence == ConfidenceKind::None) return {};
  const bool informative = s.options.confidence == ConfidenceKind::Informative;
  const ConfidenceModel model =
      informative ? ConfidenceModel{1.5, -1.2, 0.8} : ConfidenceModel{0.5, -0.4, 1.0};
  Image<float> confidence(s.depth.width(), s.depth.height(), 0.0f);
  for (std::size_t i = 0; i < confidence.size(); ++i)
    if (s.depth.data()[i] > 0) confidence.data()[i] = model.draw(s.random, s.mistake.data()[i] != 0);
  return confidence;
}

}  // namespace

void measure(SyntheticView& view, const SynthOptions& options, Random random) {
  view.view.map.depth = view.true_depth;
  view.mistake = Image<std::uint8_t>(view.true_depth.width(), view.true_depth.height());
  Spoilt s{view.true_depth, view.object, options, view.view.map.depth, view.mistake, random};
  addNoise(s);
  if (options.hard) shiftPatches(s);
  if (options.hard) mixSilhouettes(s);
  throwOutliers(s);
  quantise(s);
  dropPixels(s);
  forgiveSmallMistakes(s);
  view.view.map.confidence = drawConfidence(s);
}

}  // namespace vdbfuse::synth
