// SPDX-License-Identifier: Apache-2.0
// The library in thirty lines: a scanner that does not exist looks at a sphere, and its depth maps become a
// mesh.
//   example_01_sphere [OUT.ply]
#include <cstdio>
#include <exception>

#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/synth/synthetic_scan.h"

int main(int argc, char** argv) try {
  vdbfuse::SynthOptions scanner;
  scanner.views = 24;
  scanner.width = 160, scanner.height = 120;
  scanner.outliers = 0.1;  // every tenth depth means nothing
  const vdbfuse::SyntheticScan scan(vdbfuse::makeScene("sphere"), scanner);

  vdbfuse::ReconstructOptions options;
  options.resolution = 48;  // finest cells: the longest side of the domain / 48
  const vdbfuse::Reconstruction result = reconstruct(scan.views(), options);

  const vdbfuse::TopologyReport report = vdbfuse::topology(result.mesh);
  std::printf("%zu triangles, %zu components, %zu open edges\n", result.mesh.triangles.size(),
              report.components, report.open_edges);
  if (argc > 1) vdbfuse::writeMesh(argv[1], result.mesh);
  return report.open_edges == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
