// SPDX-License-Identifier: Apache-2.0
// C(x), the number of views that agree on a surface at x, and ρ(x) = e^(−μ C(x))  (Hernández et al. 2007, eq.
// 3).
#pragma once

#include "vdbfuse/base/progress.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/judged_view.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// A surface is supported where this many reliable views agree; fewer is a stray point.
inline constexpr float kSupported = 0.3f;

/// C(x) = Σ over views of w (1 − ε) exp(−(r/max(h, s))²), r = |D − d|, within two widths. Each view counts at
/// most once, so that μ keeps its meaning at every resolution. Grid "support", background 0, leaves near
/// reliable pixels inside `domain` only.
ScalarGrid countAgreement(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                          const Progress& progress = {});

/// ρ = max(ρ₀, e^(−μ C)) (Hernández et al. 2007, eq. 3), ρ₀ = `least`: grid "rho", background 1.
ScalarGrid discontinuityCost(const ScalarGrid& support, double mu, double least = 0.0);

}  // namespace vdbfuse
