// SPDX-License-Identifier: Apache-2.0
// A folder of depth maps with poses, in any format that `vdbfuse formats` lists, to a mesh with colours.
//   example_02_rgbd_folder FOLDER OUT.ply [VOXEL]
// VOXEL in the unit of the poses; without it as fine as the data.
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/pipeline/reconstruct.h"

int main(int argc, char** argv) try {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s FOLDER OUT.ply [VOXEL]\n", argv[0]);
    return 2;
  }
  const vdbfuse::DepthSet set = vdbfuse::readDepthSet(argv[1]);
  std::printf("%zu views as %s: %s\n", set.views.size(), set.format.c_str(), set.reading.stored.c_str());
  for (const std::string& note : set.notes) std::printf("note: %s\n", note.c_str());

  vdbfuse::ReconstructOptions options;
  if (argc > 3) options.voxel = std::atof(argv[3]);
  vdbfuse::Reconstruction result = reconstruct(set.views, options);
  const vdbfuse::ColorReport color = colorReconstruction(set.views, result);

  const vdbfuse::CalibrationReport& sensor = result.calibration;
  std::printf("the sensor: noise %.2g at depth %.2g, %.1f %% outliers\n", sensor.noise_scale,
              sensor.median_depth, 100 * sensor.outlier_share);
  std::printf("%zu triangles, voxel %.3g, colours from %zu pictures\n", result.mesh.triangles.size(),
              result.grid.voxel, color.views);
  vdbfuse::writeMesh(argv[2], result.mesh);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
