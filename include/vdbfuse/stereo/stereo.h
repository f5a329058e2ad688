// SPDX-License-Identifier: Apache-2.0
// Depth maps with confidence from photographs with known cameras (Hernández, Vogiatzis, Cipolla 2007,
// sec. 3.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/sensor/noise_model.h"
#include "vdbfuse/sensor/photograph.h"
#include "vdbfuse/sensor/view.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse {

/// The depth map of one photograph. All images have its size.
struct StereoView {
  /// Depth; confidence in [0, 1]: the votes for the depth, of its partners and of the other views' depths,
  /// divided by what they would be if all agreed fully; the picture (grey ones as three equal channels) and
  /// the mask of the photograph; alternatives where they were asked for, as exact as a sweep at half the size
  /// or less.
  View view;
  Image<float> second_best;           ///< confidence of the next best other depth, 0: none
  Image<std::uint8_t> voters;         ///< partners that agree with the depth
  std::vector<std::size_t> partners;  ///< numbers of the photographs it was matched with
  DepthInterval depths;               ///< that were looked at
  /// Spread of the partners' votes, in pixels of the partner with the widest baseline; 0: unknown
  /// (Mode::Paper).
  double matching_error_px = 0;
  NoiseLaw noise;  ///< what that is as depth: quadratic
};

struct StereoResult {
  std::vector<StereoView> views;  ///< in the order of the photographs
  std::vector<StepTime> steps;
};

/// One law for all views: the median of the quadratic coefficients of those that have one; nothing when none
/// has.
std::optional<NoiseLaw> medianNoise(const StereoResult& result);

/// Throws InvalidArgument for unusable options or fewer than two photographs, IoError from their loader,
/// Cancelled. The same bytes for any number of threads.
StereoResult computeDepthMaps(const PhotographSequence& photographs, const StereoOptions& options = {},
                              const Progress& progress = {});

}  // namespace vdbfuse
