// SPDX-License-Identifier: Apache-2.0
// The graph of an octree and its minimum cut: E[S] = ∫_S ρ dA + λ ∫_V(S) σ dV  (Hernández et al. 2007, eq.
// 1), in which V(S) is the solid.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/octree/cell_faces.h"
#include "vdbfuse/octree/octree.h"

namespace vdbfuse {

enum class CellLabel : std::uint8_t { Outside, Inside };

/// What lies beyond the domain.
enum class Border {
  Outside,  ///< empty space: an object seen from outside
  Solid,    ///< matter: a room seen from within
  Free,     ///< nothing is said
};

/// "outside", "solid" or "free".
const char* nameOf(Border border);

struct CutOptions {
  double mu = 2.0;  ///< ρ = max(ρ₀, e^(−μ C)): where two reliable views agree a surface costs next to nothing
  /// ρ₀ in [0, 1], what a surface costs however many views agree. Without it folds and handles within the
  /// noise cost nothing where voxels are smaller than the noise; with it the surface has a tension.
  double least_cost = 0.0;
  double lambda = 0.0;  ///< weight of σ, 1/length; a part of thickness τ survives if λ |σ| τ ≥ 2ρ
  double max_evidence =
      10.0;  ///< |σ| is clamped to this, so that no place is beyond the reach of its surroundings
  Border border = Border::Outside;

  /// ρ where C = `agreement` views agree, eq. (3).
  double cost(double agreement) const { return std::max(least_cost, std::exp(-mu * agreement)); }
};

struct CutEnergy {
  double surface = 0;  ///< ∫ ρ dA, in units of length²
  double volume = 0;   ///< λ ∫_V σ dV, in the same unit
};

struct Labelling {
  std::vector<CellLabel> labels;  ///< a cell each
  std::int64_t flow = 0;          ///< in units of the integer scale
  bool certified = false;         ///< the certificate of the cut was checked and holds
  std::size_t nodes = 0, arcs = 0;
  CutEnergy energy;
};

/// The global minimum of (1) with the face-sharing graph's metric. `support`: C at each cell; `sigma`:
/// evidence. ρ at a face is that of C, the mean of both sides. Among minimal solids the smallest is
/// returned. `tiles` are tileCells(octree). REQUIRES: arrays of octree.cellCount() values.
Labelling cutCells(const Octree& octree, const CellTiles& tiles, const std::vector<float>& support,
                   const std::vector<float>& sigma, const CutOptions& options, const Progress& progress = {});

/// The network of that cut: what cutCells() solves. Refers to its arguments. Capacities are integers, 2¹⁵
/// units per h² of ρ and at least one, for all levels alike: the six faces of a cell of 64 voxels a side stay
/// below 2³⁰, and ρ down to e^(−6), λ|σ|h down to 0.002 are kept to 1 % at the finest level, on coarser ones
/// smaller values still. Throws InvalidArgument for a negative lambda or mu and for a least cost outside [0,
/// 1].
NetworkSource cutSource(const Octree& octree, const CellTiles& tiles, const std::vector<float>& support,
                        const std::vector<float>& sigma, const CutOptions& options);

struct CavityReport {
  std::size_t filled = 0;  ///< components
  double volume = 0;       ///< their volume, length³
};

/// Turns empty components that no sensor can see into solid: those that hold no sensor and do not reach the
/// border (which is open unless it is solid and some sensor lies inside the domain).
CavityReport fillUnseenCavities(const Octree& octree, const CellTiles& tiles,
                                const std::vector<Eigen::Vector3d>& sensors, Border border,
                                std::vector<CellLabel>& labels);

struct SpeckReport {
  std::size_t removed = 0;  ///< components
  double volume = 0;        ///< their volume, length³
};

/// Turns solid components smaller than `least_volume` (length³) into empty ones, unless they touch a border
/// beyond which there is matter, or nothing is said. Where voxels are smaller than the
/// noise, the cut finds single voxels of the other sign within it, and depths from a window of pixels show
/// nothing smaller than that: nothing of that size can be told from an error. A component is joined across
/// faces: what hangs on by an edge alone goes.
SpeckReport removeSpecks(const Octree& octree, const CellTiles& tiles, double least_volume, Border border,
                         std::vector<CellLabel>& labels);

/// Value of a finest grid at each cell: the voxel's own at a finest cell, in coarser ones the mean of what
/// reaches `threshold` over all of their voxels, the others being 0.
std::vector<float> sampleCells(const Octree& octree, const ScalarGrid& grid, float threshold);

}  // namespace vdbfuse
