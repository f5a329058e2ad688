// SPDX-License-Identifier: Apache-2.0
// Where to reconstruct, when nobody says: around what reliable pixels of several views agree on.
#pragma once

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Box around the places that two views or more (one, when there is only one) support with reliable points,
/// widened by 3 % of its diagonal. One wild depth, or any number of pixels that nobody believes, does not
/// change it. Throws InvalidArgument when no place is supported.
Box supportedDomain(const JudgedViews& judged);

/// Widens [near, far] so that it holds every point of `domain` that lies in front of some sensor.
void widenRange(JudgedViews& judged, const Box& domain);

}  // namespace vdbfuse
