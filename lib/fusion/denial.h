// SPDX-License-Identifier: Apache-2.0
// Leave-one-out denial: where a pixel claims free space, what do all other views say?
#pragma once

#include "fusion/pixel_testimony.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Sets `denial` of every measured pixel: the bin of the smallest evidence (outside model, all other views)
/// among the points of its ray inside `domain` that are nearer than its depth by more than max(3 s, 2 grid
/// steps/cos), cos the incidence where it is known, at least 0.2. Bins end at −3, −2, −1, −0.3, 0.5, 2.
/// Evaluated on a regular grid of kDenialSide points along the domain's longest side.
void examineDenial(const JudgedViews& judged, const Box& domain, Testimonies& testimonies,
                   const Progress& progress);

inline constexpr int kDenialSide = 96;

}  // namespace vdbfuse
