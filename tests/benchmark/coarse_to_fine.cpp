// SPDX-License-Identifier: Apache-2.0
// coarse_to_fine RESOLUTION SCAN...: labels of the cut with decided cells whole and divided to the finest
// level, and how far the evidence of coarse cells, a mean over 8 or 64 samples, is from the mean over all of
// their voxels.
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "pipeline/decided_cells.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/pipeline/judge_scan.h"

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: coarse_to_fine RESOLUTION SCAN...\n");
    return 2;
  }
  vdbfuse::ReconstructOptions options;
  options.resolution = std::atoi(argv[1]);
  std::printf("%-36s %10s %10s %14s %12s %10s %6s %8s\n", "scan", "cells", "if divided", "decided volume",
              "other labels", "error rms", "99 %", "sign");
  std::size_t wrong = 0;
  for (int i = 2; i < argc; ++i) {
    const vdbfuse::DepthSet set = vdbfuse::readDepthSet(argv[i]);
    const vdbfuse::test::DecidedCells both =
        vdbfuse::test::solveBothWays(vdbfuse::judgeScan(set.views, options), options);
    std::printf("%-36s %10zu %10zu %12.1f %% %12zu %10.3f %6.2f %6.2f %%\n",
                std::filesystem::path(argv[i]).filename().c_str(), both.whole.octree.cellCount(),
                both.divided.octree.cellCount(), 100 * both.decided_volume_share, both.other_labels,
                both.sampling.rms, both.sampling.quantile99, 100 * both.sampling.other_sign_share);
    std::fflush(stdout);
    wrong += both.other_labels;
  }
  return wrong == 0 ? 0 : 1;
}
