// SPDX-License-Identifier: Apache-2.0
// What "from coarse to fine" leaves out: the cut once more with all decided cells divided down to the finest
// level, and every one of their parts evaluated.
#pragma once

#include <algorithm>

#include "pipeline/cells.h"
#include "pipeline/steps.h"
#include "vdbfuse/fusion/agreement.h"

namespace vdbfuse::test {

struct SolvedCells {
  Octree octree;
  std::vector<CellLabel> labels;
};

/// How far the mean over a coarse cell's samples is from that over all of its voxels, evidence clamped as the
/// cut does.
struct SamplingError {
  double rms = 0, quantile99 = 0;
  double other_sign_share = 0;  ///< of the cells
};

/// From about `count` cells, spread evenly over those of levels 1 … 4.
inline SamplingError samplingError(const JudgedViews& judged, const Octree& octree,
                                   const std::vector<float>& sigma, const EvidenceOptions& options,
                                   double most, std::size_t count = 4000) {
  std::vector<std::size_t> coarse;
  for (std::size_t c = 0; c < octree.cellCount(); ++c)
    if (octree.levels[c] >= 1 && octree.levels[c] <= 4) coarse.push_back(c);
  std::vector<double> errors;
  SamplingError result;
  for (std::size_t i = 0; i < coarse.size(); i += coarse.size() / count + 1) {
    const std::size_t c = coarse[i];
    std::vector<Eigen::Vector3d> voxels;
    const int side = octree.side(c);
    for (int k = 0; k < side * side * side; ++k)
      voxels.push_back(octree.frame.toWorld(
          Index3(octree.lowest(c) + Index3(k % side, k / side % side, k / side / side))));
    double mean = 0;
    for (const float e : evidenceAt(judged, voxels, options)) mean += std::clamp<double>(e, -most, most);
    mean /= static_cast<double>(voxels.size());
    const double sampled = std::clamp<double>(sigma[c], -most, most);
    errors.push_back(std::abs(sampled - mean));
    result.rms += errors.back() * errors.back();
    result.other_sign_share += (sampled > 0) != (mean > 0);
  }
  if (errors.empty()) return result;
  const auto total = static_cast<double>(errors.size());
  result.rms = std::sqrt(result.rms / total), result.other_sign_share /= total;
  const auto nth = errors.begin() + static_cast<std::ptrdiff_t>(0.99 * (total - 1));
  std::nth_element(errors.begin(), nth, errors.end());
  result.quantile99 = *nth;
  return result;
}

/// Both solutions of one scan.
struct DecidedCells {
  SolvedCells whole, divided;
  std::size_t decided = 0;       ///< cells
  std::size_t other_labels = 0;  ///< finest voxels whose labels differ: should be 0
  double decided_volume_share = 0;
  SamplingError sampling;
};

/// Of these cells those that can be divided so that grading divides no others.
inline std::vector<std::size_t> dividedAlone(const Octree& octree, std::vector<bool> wanted) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t c = 0; c < octree.cellCount(); ++c) {
      if (!wanted[c]) continue;
      for (int n = 0; n < 27 && wanted[c]; ++n) {
        const Index3 step = octree.side(c) * Index3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        const auto next = octree.find(octree.lowest(c) + step);
        if (next && octree.levels[*next] > octree.levels[c] && !wanted[*next])
          wanted[c] = false, changed = true;
      }
    }
  }
  std::vector<std::size_t> cells;
  for (std::size_t c = 0; c < octree.cellCount(); ++c)
    if (wanted[c] && octree.levels[c] > 0) cells.push_back(c);
  return cells;
}

inline DecidedCells solveBothWays(const JudgedScan& scan, const ReconstructOptions& options) {
  const JudgedViews& judged = scan.judgement.judged;
  const Box& domain = scan.judgement.domain;
  const GridFrame frame = chooseFrame(domain, scan.calibration, options);
  const ScalarGrid support = countAgreement(judged, frame, domain);
  const CutOptions cut = cutOptions(judged, domain, frame, scan.calibration, options);
  const EvidenceOptions evidence_options = evidenceOptions(judged, domain, options);
  const DivideOptions divide{cut.lambda, cut.max_evidence};
  const CellsWithEvidence cells = evaluateFromCoarseToFine(
      judged, support,
      buildOctree(support, kSupported, domain, octreeOptions(frame, scan.calibration, options)),
      evidence_options, divide, {});
  DecidedCells result;
  result.whole.octree = cells.octree;
  result.whole.labels = cutCells(cells.octree, cells.tiles, cells.support, cells.sigma, cut).labels;

  CellEvidence evidence(cells.octree.cellCount());
  evaluateCells(judged, cells.octree, evidence_options, evidence);
  // The very numbers of the other solution: points in other company may fall to another pixel.
  evidence.mean = cells.sigma;
  std::vector<bool> decided(cells.octree.cellCount());
  for (std::size_t c = 0; c < decided.size(); ++c) {
    const double side = cells.octree.side(c) * frame.voxel;
    decided[c] = isDecided(side, evidence.weakest[c], cells.support[c], divide);
    result.decided += decided[c];
    result.decided_volume_share += decided[c] ? side * side * side : 0;
  }
  result.decided_volume_share /= std::pow(frame.voxel, 3) * cells.octree.size.cast<double>().prod();

  result.sampling = samplingError(judged, cells.octree, cells.sigma, evidence_options, cut.max_evidence);

  Octree octree = cells.octree;
  for (;;) {
    const std::vector<std::size_t> next = dividedAlone(octree, decided);
    if (next.empty()) break;
    Octree finer = refined(octree, next);
    evidence = carriedOver(octree, evidence, finer);
    std::vector<bool> parts(finer.cellCount());
    for (std::size_t c = 0; c < parts.size(); ++c) parts[c] = decided[*octree.find(finer.lowest(c))];
    octree = std::move(finer), decided = std::move(parts);
  }
  evaluateCells(judged, octree, evidence_options, evidence);
  result.divided.labels =
      cutCells(octree, tileCells(octree), sampleCells(octree, support, kSupported), evidence.mean, cut)
          .labels;
  result.divided.octree = std::move(octree);
  const SolvedCells& fine = result.divided;
  for (std::size_t c = 0; c < fine.octree.cellCount(); ++c) {
    const CellLabel label = result.whole.labels[*cells.octree.find(fine.octree.lowest(c))];
    if (label != fine.labels[c]) result.other_labels += std::size_t{1} << 3 * fine.octree.levels[c];
  }
  return result;
}

}  // namespace vdbfuse::test
