// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/synth/synth_options.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

constexpr double kObjectRadius = 0.5;  // half of the diagonal

bool isShare(double x) { return x >= 0 && x <= 1; }

}  // namespace

std::vector<std::string> validate(const SynthOptions& o) {
  std::vector<std::string> problems;
  const auto require = [&](bool good, const char* sentence) {
    if (!good) problems.emplace_back(sentence);
  };
  constexpr int kLargestSide = 16384;
  require(o.views > 0, "views must be positive");
  require(o.width > 0 && o.height > 0, "width and height must be positive");
  require(o.width <= kLargestSide && o.height <= kLargestSide, "width and height must be at most 16384");
  require(o.noise_scale >= 0 && std::isfinite(o.noise_scale), "the noise scale must not be negative");
  require(!o.noise_px || (*o.noise_px >= 0 && std::isfinite(*o.noise_px)),
          "the matching error must not be negative");
  require(o.quantum >= 0 && std::isfinite(o.quantum), "the step of depths must not be negative");
  require(!o.focal_px || (*o.focal_px > 0 && std::isfinite(*o.focal_px)),
          "the focal length must be positive");
  require(o.baseline > 0, "the baseline must be positive");
  require(isShare(o.outliers), "the share of outliers must lie in [0, 1]");
  require(isShare(o.missing), "the share of missing pixels must lie in [0, 1]");
  require(o.arc != Arc::Room || o.background == Background::None,
          "a room has walls already: no wall behind it");
  if (!o.photographs) return problems;
  const PhotographOptions& p = *o.photographs;
  require(p.gain >= 1 && std::isfinite(p.gain), "the gain must be at least 1");
  require(p.bias >= 0 && std::isfinite(p.bias), "the bias must not be negative");
  require(p.noise >= 0 && std::isfinite(p.noise), "the noise of the image must not be negative");
  require(isShare(p.gloss), "the gloss must lie in [0, 1]");
  return problems;
}

SynthOptions hardened(SynthOptions options) {
  constexpr double kOutliers = 0.08;
  options.hard = true;
  options.outliers = kOutliers;
  options.confidence = ConfidenceKind::Overlapping;
  return options;
}

double focalLength(const SynthOptions& options) {
  if (options.focal_px) return *options.focal_px;
  constexpr double kMargin = 1.03, kRoomFocal = 0.75;
  const double half_side = 0.5 * std::min(options.width, options.height);
  if (options.arc == Arc::Room) return 2 * half_side * kRoomFocal;
  const double reach =
      std::sqrt(kCameraDistance * kCameraDistance - kObjectRadius * kObjectRadius) / kObjectRadius;
  return half_side / kMargin * reach;
}

SynthOptions kinectOptions() {
  SynthOptions options;
  options.views = 24;
  options.arc = Arc::Upper;
  options.noise_law = SynthNoise::StructuredLight;
  options.noise_scale = 0.0012 + 0.0019 * 0.6 * 0.6;
  options.quantum = 0.001;
  options.focal_px = 525;
  options.confidence = ConfidenceKind::None;
  return options;
}

double noiseScale(const SynthOptions& options) {
  if (!options.noise_px) return options.noise_scale;
  return *options.noise_px / (focalLength(options) * options.baseline);
}

double noiseSigma(const SynthOptions& options, double z) {
  const double scale = noiseScale(options);
  const auto nguyen = [](double depth) { return 1.2 + 1.9 * (depth - 0.4) * (depth - 0.4); };
  switch (options.noise_law) {
    case SynthNoise::Stereo:
      return scale * z * z;
    case SynthNoise::StructuredLight:
      return scale * nguyen(z) / nguyen(1.0);
    case SynthNoise::Constant:
      return scale;
  }
  return scale;
}

DepthRange depthRange(const SynthOptions& options) {
  constexpr double kSlack = 0.1;
  if (options.arc == Arc::Room) return {0.2, 5.0};
  const double near = kCameraDistance - kObjectRadius - kSlack;
  if (options.background == Background::Wall) return {near, kCameraDistance + kWallRadius + kSlack};
  return {near, kCameraDistance + kObjectRadius + kSlack};
}

}  // namespace vdbfuse
