// SPDX-License-Identifier: Apache-2.0
// Which cells are worth dividing, from coarse to fine, when the evidence of the coarse ones is known.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "vdbfuse/octree/cell_tiles.h"
#include "vdbfuse/octree/octree.h"

namespace vdbfuse {

/// σ of cells.
struct CellEvidence {
  explicit CellEvidence(std::size_t cells = 0)
      : mean(cells, std::numeric_limits<float>::quiet_NaN()), weakest(cells, 0.0f) {}
  std::vector<float> mean;     ///< not a number where it was not evaluated
  std::vector<float> weakest;  ///< the sample nearest to zero; zero where samples differ in sign
};

struct DivideOptions {
  double lambda = 0.0;         ///< weight of σ in the energy, 1/length
  double max_evidence = 10.0;  ///< CutOptions::max_evidence
};

/// Says whether no labelling of minimal energy (eq. 1) can divide a cell, or label it against its evidence,
/// whatever lies around it and however finely it is divided:  λ |σ| side ≥ 6 everywhere in a cell in which
/// ρ = 1.
///
/// Why: let Q be a cube of n³ finest cells with ρ = 1 inside and σ ≥ q > 0, S minimal, T = S ∩ Q. Taking T
/// out of S saves λ ∫_T σ ≥ λ q h |T| and all faces between T and Q∖T, and costs at most the faces between T
/// and what lies around Q, ρ ≤ 1 each (in units of h²). Count along lines of cells through Q, by axis: a line
/// that is wholly in T costs its two ends and saves none; any other costs at most its ends in T and saves a
/// face for each of them, because it must leave T again inside Q. With X, Y, Z lines wholly in T the price is
/// at most 2(X + Y + Z), and |T| ≥ n max(X, Y, Z) ≥ n (X + Y + Z)/3, so that λ q h n ≥ 6 makes the trade a
/// gain or even: S without T is minimal too, and with > strictly better. The same for σ < 0 with the sides
/// exchanged. For n = 1, the undivided cell, it is the same inequality. So a decided cell has its label in
/// both graphs, and the rest of the graph sees the same label across the same faces.
///
/// Evidence is known at samples only (2³ in a cell of 2 or 4 voxels a side, 4³ in larger ones) and may be
/// weaker between them: twice as much is asked of the weakest one. Measured on the 40 scans of the scenario
/// matrix (tests/benchmark/coarse_to_fine): with 6 one cell of one scan came out otherwise when divided, with
/// 12 none.
bool isDecided(double side, float weakest_evidence, float support, const DivideOptions& options);

/// Cells, not finest, not decided and without support, next to one of opposite evidence, also without
/// support: boundaries of visibility, away from any measurement. Only where it matters: λ |σ| side ≥ 1 with
/// the weaker |σ| of the two.
std::vector<std::size_t> cellsToDivide(const Octree& octree, const CellTiles& tiles,
                                       const std::vector<float>& support, const CellEvidence& evidence,
                                       const DivideOptions& options);

/// What is known of the cells of `from` that are cells of `to` as well.
CellEvidence carriedOver(const Octree& from, const CellEvidence& evidence, const Octree& to);

}  // namespace vdbfuse
