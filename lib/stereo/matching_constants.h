// SPDX-License-Identifier: Apache-2.0
// What the fast path and mode `paper` have in common.
#pragma once

namespace vdbfuse::stereo {

/// Standard deviation of the Gaussian W by which a partner votes for the depths around its own, in steps.
inline constexpr double kVoteSigma = 2;
/// Peaks of correlation below it do not vote: t of the paper. Windows that face the camera.
inline constexpr double kFirstThreshold = 0.5;
/// The same, of windows that lie along the surface found before.
inline constexpr double kSurfaceThreshold = 0.3;
/// Motion of the image from one step to the next, pixels; mode `paper`.
inline constexpr double kPaperStep = 0.5;
/// Windows whose brightness has a standard deviation below this one have no texture and no correlation: one
/// and a half grey levels of an 8-bit picture, a little above its rounding and compression.
inline constexpr double kLeastDeviation = 1.5 / 255;

}  // namespace vdbfuse::stereo
