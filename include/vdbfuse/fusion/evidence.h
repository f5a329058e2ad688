// SPDX-License-Identifier: Apache-2.0
// σ(x): the evidence (log-odds) that x is visible, that is outside. σ > 0 outside, σ < 0 inside; never
// clamped here.
#pragma once

#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/octree/divide.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// How the views' testimony is combined.
enum class EvidenceRule {
  /// "x is outside": each sensor sees past x with probability v, independently; inside: none does. v is
  /// integrated
  /// out under Beta(a, 1):  e = b + log ∫ Beta(v; a, 1) Π_i (1 − v + v L_i)^w_i dv.
  Outside,
  /// The paper's equation (5): visible from at least one sensor, e = log((1 − Π π_i)/Π π_i).
  Paper,
  /// No self-occlusion (equations 10 and 11): an outside point is seen by every sensor,
  /// e = Σ w_i log((1 − π_i)/π_i). With logistic noise, no outliers and an infinite range: the Curless–Levoy
  /// sum.
  NoSelfOcclusion,
  /// Constant ballooning: e = −balloon everywhere. The baseline of the paper's Fig. 4.
  Constant,
};

struct EvidenceOptions {
  EvidenceRule rule = EvidenceRule::Outside;
  /// a of the visibility's prior Beta(v; a, 1). Smaller: outside points may be seen by fewer sensors, so that
  /// more denials are needed to call a point inside. Dimensionless.
  double visibility_prior = 0.5;
  /// A single v in place of the integral, in (0, 1]; 0: integrate.
  double visibility = 0.0;
  /// Upper bound of b, the prior log-odds of outside. Where n views report b(n) = min(prior, −½ log ∫ Beta
  /// (1−v)ⁿ dv). Larger: less is filled in where few views deny, also inside thin parts.
  double prior = 0.0;
  /// τ: how far behind a measured surface the same solid is to be expected, length; 0: at any distance alike.
  /// At δ behind its measurement a view counts as g = e^(−(δ/τ)²) of a view, in the product and in b: from
  /// far behind it knows only that something is in between. Where e < 0 it is multiplied by the views' mean
  /// of g besides, so that the shadow of many views does not reach further than that of few. Rule Outside.
  double thickness = 0.0;
  /// Inflation of constant ballooning, log-odds.
  double balloon = 1.0;
  /// At most so many views' no-returns count at a point, by their weights.
  int max_no_returns = 4;
  /// Share m of the pixels of silhouette masks that call object what is background, or the reverse, in (0,
  /// 0.5). Smaller: masks that confirm each other carve more against depths that deny (logMaskRatio).
  double mask_error = 0.02;
};

std::vector<std::string> validate(const EvidenceOptions& options);

/// log L of a look that met nothing: L = (q + (1−q) m)/m with q = ½ and the miss rate m not below 0.2.
double logNoReturnRatio(double miss_rate);

/// log L of a pixel outside its silhouette mask. A ray through the object at x is called outside with
/// probability m only; a ray that sees past x is called so with 1 − m when it meets nothing behind x (q = ½),
/// else with m:  L = (q (1−m) + (1−q) m)/m, 25 for m = 0.02. It holds along the whole ray, with or without a
/// depth. In the rules Outside and NoSelfOcclusion the first view's worth of masks at a point counts with L ≤
/// 3 only, so that no single mask carves what two views deny.
double logMaskRatio(double mask_error);

/// Evidence at world points. One value a point.
std::vector<float> evidenceAt(const JudgedViews& judged, const std::vector<Eigen::Vector3d>& points,
                              const EvidenceOptions& options);

/// Evidence of each cell of an octree: at the centre of a finest cell, mean over 8 or 64 samples in a coarser
/// one. Against the mean over all voxels of a coarse cell, both clamped to 10, that is off by 0.01 to 1.1
/// (root mean square over the cells of a scan, twelve scans), and of the other sign in up to 2 % of the cells
/// (tests/benchmark/coarse_to_fine).
std::vector<float> evidence(const JudgedViews& judged, const Octree& octree, const EvidenceOptions& options,
                            const Progress& progress = {});

/// The same for the cells whose mean is not a number yet, and the weakest of their samples.
void evaluateCells(const JudgedViews& judged, const Octree& octree, const EvidenceOptions& options,
                   CellEvidence& evidence, const Progress& progress = {});

}  // namespace vdbfuse
