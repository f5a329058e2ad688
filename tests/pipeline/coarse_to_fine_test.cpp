// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "pipeline/decided_cells.h"
#include "pipeline/scan_scenes.h"
#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {
namespace {

// `tests/benchmark/coarse_to_fine` does the same on scans of any size.
TEST(CoarseToFine, DividingDecidedCellsAsWellChangesNoLabel) {
  for (const Arc arc : {Arc::Full, Arc::Upper}) {
    SynthOptions options;
    options.views = 16, options.arc = arc, options.noise_scale = 0.002, options.outliers = 0.05;
    const JudgedScan scan = judgeScan(
        ViewSequence::fromViews(test::viewsOf(test::smallScan(makeScene("figure", {1.0 / 64}), options))));
    ReconstructOptions reconstruct;
    reconstruct.voxel = 0.012;
    const test::DecidedCells both = test::solveBothWays(scan, reconstruct);
    EXPECT_GT(both.decided_volume_share, 0.02);
    EXPECT_GT(both.divided.octree.cellCount(), both.whole.octree.cellCount());
    EXPECT_EQ(both.other_labels, 0u);
  }
}

TEST(CoarseToFine, CellsAtBoundariesOfVisibilityAreDividedAndOnlyTheNewOnesEvaluated) {
  SynthOptions options;
  options.views = 12, options.arc = Arc::Ring, options.noise_scale = 0.001;
  const JudgedScan scan = judgeScan(
      ViewSequence::fromViews(test::viewsOf(test::smallScan(makeScene("box", {1.0 / 32}), options))));
  const JudgedViews& judged = scan.judgement.judged;
  ReconstructOptions reconstruct;
  reconstruct.voxel = 0.008;
  const GridFrame frame{reconstruct.voxel};
  const ScalarGrid support = countAgreement(judged, frame, scan.judgement.domain);
  const Octree octree = buildOctree(support, kSupported, scan.judgement.domain);
  const EvidenceOptions evidence_options = evidenceOptions(judged, scan.judgement.domain, reconstruct);
  const CellsWithEvidence cells =
      evaluateFromCoarseToFine(judged, support, octree, evidence_options, {75.0}, {});
  EXPECT_GT(cells.octree.cellCount(), octree.cellCount());
  // Points in other company may fall to the other side of the border between two pixels (block_kernels.h).
  const std::vector<float> all = evidence(judged, cells.octree, evidence_options);
  std::size_t same = 0;
  for (std::size_t c = 0; c < all.size(); ++c) same += std::abs(cells.sigma[c] - all[c]) < 1e-3f;
  EXPECT_GT(static_cast<double>(same), 0.998 * static_cast<double>(all.size()));
}

}  // namespace
}  // namespace vdbfuse
