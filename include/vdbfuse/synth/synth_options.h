// SPDX-License-Identifier: Apache-2.0
// What a synthetic scanner is like, and where it stands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbfuse {

/// Where the cameras stand. All but Room look at the centre from a distance of kCameraDistance.
enum class Arc {
  Full,   ///< all around (Fibonacci sphere)
  Ring,   ///< one turn around the vertical, 10° above the horizon: a turntable
  Upper,  ///< the upper half of the sphere
  Front,  ///< a cap of ±50° around the scene's front
  Room,   ///< inside a closed room around the object: every other one looks at it, the rest at the walls
};

/// How the standard deviation of a depth grows with the depth z; every law gives `noise_scale` at z = 1.
enum class SynthNoise {
  Stereo,           ///< ∝ z²
  StructuredLight,  ///< ∝ 1.2 + 1.9 (z − 0.4)² (Nguyen, Izadi, Lovell, 3DIMPVT 2012)
  Constant,
};

/// What the confidences know of wrong pixels. All lie in (0, 1), higher is better.
enum class ConfidenceKind {
  None,         ///< no confidence is given
  Informative,  ///< two classes 3.4 standard deviations apart: 4 % of each lie beyond the middle
  Overlapping,  ///< 0.9 standard deviations apart: a third of each lies beyond the middle
};

enum class Background {
  None,  ///< rays that miss the object return nothing
  Wall,  ///< a measured sphere of radius kWallRadius around everything; no part of the truth
};

/// How the pictures of textured scenes are taken.
struct PhotographOptions {
  /// Exposures differ by view: brightness is multiplied by a factor between 1/gain and gain, uniform in its
  /// logarithm. ≥ 1.
  double gain = 1;
  /// Grey levels (of 255) in ±bias, uniform, are added by view.
  double bias = 0;
  double noise = 1;    ///< standard deviation in each channel of each pixel, grey levels
  double gloss = 0.1;  ///< brightness, in [0, 1], of highlights, which move with the camera
};

inline constexpr double kCameraDistance = 1.5;  ///< in diagonals of the scene
inline constexpr double kWallRadius = 3.0;
inline constexpr double kRingElevationDeg = 10.0;
inline constexpr double kFrontHalfAngleDeg = 50.0;

struct SynthOptions {
  int views = 48;
  Arc arc = Arc::Full;
  int width = 640, height = 480;  ///< pixels
  SynthNoise noise_law = SynthNoise::Stereo;
  /// Standard deviation of the (Gaussian) noise at z = 1, in diagonals of the scene. 0: exact depths.
  double noise_scale = 0.001;
  /// When given, replaces noise_scale by noise_px/(focal length · baseline): a matching error in pixels.
  std::optional<double> noise_px;
  /// Depths are multiples of this, in diagonals of the scene. 0: any depth.
  double quantum = 0;
  /// Focal length in pixels; default: the scene just fits the image.
  std::optional<double> focal_px;
  /// Of the stereo pair that noise_px speaks of, in diagonals of the scene: one third of the distance, 19°.
  double baseline = 0.5;
  /// Share of all pixels, in [0, 1], whose depth is replaced by one uniform in [near, far]. Pixels that see
  /// nothing are hit as well, as a matcher imagines depths before an empty background.
  double outliers = 0;
  /// Half of the silhouette pixels are mixed with what lies behind them, and ten patches a view (6–22 pixels
  /// of radius at a width of 640, proportional otherwise) are off by 2–25 % of the object's size, to either
  /// side.
  bool hard = false;
  /// Share of all pixels, in [0, 1], without a return.
  double missing = 0;
  ConfidenceKind confidence = ConfidenceKind::Informative;
  Background background = Background::None;
  /// When given, surfaces are textured and lit, and every view has a picture.
  std::optional<PhotographOptions> photographs;
  std::uint64_t seed = 1;
};

/// Everything that is wrong with the options, one sentence each; empty when they can be used.
std::vector<std::string> validate(const SynthOptions& options);

/// What --hard stands for on the command line: mistakes as an honest stereo matcher makes them.
SynthOptions hardened(SynthOptions options);

/// A structured-light camera like the first Kinect, lengths in metres: 24 views of 640×480 from the upper
/// half of the sphere, 1.5 m from the centre, focal length 525 pixels, depths in millimetres, noise 1.2 mm
/// + 1.9 mm (z − 0.4)² (z in metres; Nguyen, Izadi, Lovell 2012), no confidence. For the scene `ball`.
SynthOptions kinectOptions();

/// Focal length, in pixels: the bounding sphere of the scene just fits the shorter side of the image; in a
/// room a field of view of 67°.
double focalLength(const SynthOptions& options);

/// noise_scale, or what noise_px makes of it.
double noiseScale(const SynthOptions& options);

/// Standard deviation of the noise at depth z.
double noiseSigma(const SynthOptions& options, double z);

/// Depths that the sensor could report; outliers are uniform in it.
struct DepthRange {
  double near = 0, far = 0;
};
DepthRange depthRange(const SynthOptions& options);

}  // namespace vdbfuse
