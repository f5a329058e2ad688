// SPDX-License-Identifier: Apache-2.0
// How densely the views sample the surfaces: what a voxel can hope to resolve.
#pragma once

#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Median distance, in world units, between neighbouring measurements of the same view, noise included: the
/// side of a square that holds one point, from the eight nearest points in space. Unlike the footprint of a
/// pixel it knows of slanted surfaces, of sensors that are denser along one axis, and of views with different
/// sensors. From patches of up to 16 views spread over the sequence; 0 when no patch has nine pixels that are
/// rather right than wrong.
double pointSpacing(const JudgedViews& judged);

}  // namespace vdbfuse
