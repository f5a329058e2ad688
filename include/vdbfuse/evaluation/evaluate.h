// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/evaluation/regions.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

struct EvaluateOptions {
  /// Distances at which precision, recall and F-score are given, in the unit of the meshes, all positive.
  /// Empty: one, 1 % of the diagonal of the truth's bounding box.
  std::vector<double> taus;
  /// Points on each surface. The standard error of a share is below 0.5 / √samples, 0.1 % here.
  std::size_t samples = 200000;
  /// Points along the longest side of the truth's bounding box for the IoU, one a cell; twice as many cost
  /// eight times as much. With this default the IoU is good to about 0.001.
  int iou_resolution = 128;
  /// When given, also the volume that is wrong and further than this from the true surface, in the unit of
  /// the meshes, not negative: a limb lost or invented, and not a surface that is a little off.
  std::optional<double> deep;
  /// Points a region: shares are good to 0.3 %.
  std::size_t region_samples = 20000;
  std::uint64_t seed = 1;
};

/// Everything that is wrong with the options, a sentence each; empty when they are fine.
std::vector<std::string> validate(const EvaluateOptions& options);

/// Shares in [0, 1] at one distance tau.
struct ScoreAtTau {
  double tau;
  double precision;  ///< of the mesh's samples, within tau of the truth
  double recall;     ///< of the truth's samples, within tau of the mesh
  double fscore;     ///< harmonic mean of the two; 0 when both are
};

struct RegionShare {
  std::string name;
  Expectation expect;
  /// Of the region's points where the truth is as expected: the share where the mesh is so, too. None when
  /// the truth is nowhere as expected.
  std::optional<double> share;
};

struct Evaluation {
  double accuracy90;  ///< 90 % of the mesh's samples lie at most that far from the truth; infinite without a
                      ///< mesh
  double accuracy_rms;             ///< root mean square of those distances; infinite without a mesh
  double completeness;             ///< share of the truth's samples within the first tau of the mesh
  std::vector<ScoreAtTau> scores;  ///< one a tau, in the order of the options
  /// Volume of the intersection over volume of the union; inside is where the generalised winding number is
  /// above one half, so that open meshes have one, too. None when neither encloses anything.
  std::optional<double> iou;
  /// Volumes deeper than `deep`, as shares of the true volume: inside in truth and outside of the mesh, and
  /// the other way round. None when not asked for, or when the truth encloses nothing.
  std::optional<double> false_outside_deep, false_inside_deep;
  TopologyReport topology;           ///< of the mesh
  std::vector<RegionShare> regions;  ///< in the order given
};

/// Compares `mesh` with `truth`, both in the same coordinates and unit. Distances are exact (ClosestPoint) at
/// seeded samples uniform by area; volumes are integrals over one random point in each cell of a grid. The
/// same result for every number of threads. InvalidArgument when the options are wrong, the truth has no
/// area, or an index is out of range.
Evaluation evaluate(const TriangleMesh& mesh, const TriangleMesh& truth, const EvaluateOptions& options = {},
                    const std::vector<Region>& regions = {});

}  // namespace vdbfuse
