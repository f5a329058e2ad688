// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "fusion/surface_kernels.h"
#include "vdbfuse/sensor/noise_model.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Calls visit(y, row) with what analyseSurface() finds in each row, rows in parallel.
void forEachSurfaceRow(const View& view, const NoiseLaw& noise,
                       const std::function<void(int y, const SurfaceRow& row)>& visit);

}  // namespace vdbfuse
