// SPDX-License-Identifier: Apache-2.0
// How depth maps are made from photographs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/stereo/neighbours.h"

namespace vdbfuse {

struct StereoOptions {
  enum class Mode {
    Fast,   ///< sweeps over a pyramid of images
    Paper,  ///< Hernández et al. 2007, sec. 3.1, to the letter: slow, for comparison
  };
  Mode mode = Mode::Fast;
  PartnerOptions partners;
  /// Side of the square that is correlated; odd. Larger: fewer mistakes in noise, rounder edges.
  int window_px = 5;
  /// Depths are looked for within it.
  std::optional<Box> domain;
  /// Depths z that are looked for, in place of what the data say. 0: from the data.
  double min_depth = 0, max_depth = 0;
  /// Depths a pixel may have, 1 to 4: DepthMap::alternatives holds the others.
  int hypotheses = 1;
  /// Pixels with less confidence have no depth. In [0, 1].
  double min_confidence = 0;
  /// Of Mode::Fast: sweeps along the slant of what was found before, at full resolution (coarser levels, and
  /// photographs so small that they have but one, take what they need). 0: none, and planes are swept at full
  /// resolution, as finely and with the votes of Mode::Paper.
  int surface_sweeps = 2;
  /// Of Mode::Fast, with surface sweeps: last passes that weigh the depth maps against each other.
  enum class CrossCheck { On, Off } cross_check = CrossCheck::On;
};

/// Everything that is wrong with the options, one sentence each.
std::vector<std::string> validate(const StereoOptions& options);

}  // namespace vdbfuse
