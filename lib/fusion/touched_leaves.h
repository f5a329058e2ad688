// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "fusion/prepared_view.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

struct TouchOptions {
  float max_outlier = 1.0f;  ///< less reliable pixels touch nothing
  /// Alternative depths touch leaves when they are right with this probability or more; above 1: never.
  float least_alternative = 2.0f;
  /// How far around a point of the given noise scale leaves are touched, length.
  std::function<double(double noise)> reach;
};

/// Origins of all leaves within reach of the views' points inside `domain`, sorted.
std::vector<Index3> touchedLeaves(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                                  const TouchOptions& options, const Progress& progress);

}  // namespace vdbfuse
