// SPDX-License-Identifier: Apache-2.0
#include "pipeline/cells.h"

#include "vdbfuse/fusion/agreement.h"

namespace vdbfuse {

CellsWithEvidence evaluateFromCoarseToFine(const JudgedViews& judged, const ScalarGrid& support,
                                           Octree octree, const EvidenceOptions& evidence_options,
                                           const DivideOptions& divide_options, const Progress& progress) {
  CellsWithEvidence cells;
  CellEvidence evidence(octree.cellCount());
  // A cell can be divided once a level.
  for (int level = octree.max_level;; --level) {
    evaluateCells(judged, octree, evidence_options, evidence, progress);
    cells.tiles = tileCells(octree);
    cells.support = sampleCells(octree, support, kSupported);
    const std::vector<std::size_t> divided =
        level > 0 ? cellsToDivide(octree, cells.tiles, cells.support, evidence, divide_options)
                  : std::vector<std::size_t>();
    if (divided.empty()) break;
    Octree finer = refined(octree, divided);
    evidence = carriedOver(octree, evidence, finer);
    octree = std::move(finer);
  }
  cells.octree = std::move(octree);
  cells.sigma = std::move(evidence.mean);
  return cells;
}

}  // namespace vdbfuse
