// SPDX-License-Identifier: Apache-2.0
// The cells of a reconstruction with everything that the cut asks of them.
#pragma once

#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/octree/graph.h"

namespace vdbfuse {

struct CellsWithEvidence {
  Octree octree;
  CellTiles tiles;
  std::vector<float> support, sigma;  ///< a cell each
};

/// σ on the octree of the support; then cells at boundaries of visibility are divided, level by level
/// (octree/divide.h), and only the new ones are evaluated.
CellsWithEvidence evaluateFromCoarseToFine(const JudgedViews& judged, const ScalarGrid& support,
                                           Octree octree, const EvidenceOptions& evidence_options,
                                           const DivideOptions& divide_options, const Progress& progress);

}  // namespace vdbfuse
