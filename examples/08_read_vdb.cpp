// SPDX-License-Identifier: Apache-2.0
// Reads with plain OpenVDB, and nothing of vdbfuse, what `vdbfuse fuse --save-grids FILE.vdb` wrote.
//   example_08_read_vdb FILE.vdb
// Lists the grids, measures the level set `surface`, and compares it with `sigma`, the evidence that it was
// found from.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace {

using openvdb::FloatGrid;

void list(const openvdb::GridBase& grid) {
  std::printf("%-10s %-10s %10llu voxels of %.4g\n", grid.getName().c_str(),
              openvdb::GridBase::gridClassToString(grid.getGridClass()).c_str(),
              static_cast<unsigned long long>(grid.activeVoxelCount()), grid.voxelSize().x());
}

/// Of the surface where the grid is 0: six times the volume is the sum of the triangles' determinants.
double volumeInside(const FloatGrid& surface) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(surface, points, quads);
  double six_times = 0;
  for (const openvdb::Vec4I& quad : quads) {
    const openvdb::Vec3d a(points[quad[0]]), b(points[quad[1]]), c(points[quad[2]]), d(points[quad[3]]);
    six_times += a.dot(b.cross(c)) + a.dot(c.cross(d));
  }
  const double volume = -six_times / 6;  // OpenVDB's polygons are clockwise seen from outside
  std::printf("surface: %zu points, %zu quads, volume %.4f\n", points.size(), quads.size(), volume);
  return volume;
}

/// Share of sigma's voxels near the surface that lie on the side which their evidence says: outside where
/// σ > 0. The grids have different transforms: they meet in the world.
double agreement(const FloatGrid& surface, const FloatGrid& sigma) {
  const openvdb::tools::GridSampler<FloatGrid, openvdb::tools::BoxSampler> distance(surface);
  std::size_t near = 0, agree = 0;
  for (FloatGrid::ValueOnCIter voxel = sigma.cbeginValueOn(); voxel; ++voxel) {
    const float d = distance.wsSample(sigma.indexToWorld(voxel.getCoord()));
    if (std::abs(d) >= surface.background()) continue;
    ++near;
    agree += (d > 0) == (*voxel > 0);
  }
  return near == 0 ? 0 : static_cast<double>(agree) / static_cast<double>(near);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FILE.vdb\n", argv[0]);
    return 2;
  }
  openvdb::initialize();
  openvdb::io::File file(argv[1]);
  file.open();
  const openvdb::GridPtrVecPtr grids = file.getGrids();
  for (const openvdb::GridBase::Ptr& grid : *grids) list(*grid);

  const auto surface = openvdb::gridPtrCast<FloatGrid>(file.readGrid("surface"));
  const auto sigma = openvdb::gridPtrCast<FloatGrid>(file.readGrid("sigma"));
  const double volume = volumeInside(*surface), agreeing = agreement(*surface, *sigma);
  std::printf("sigma: %.1f %% of the voxels near the surface are on the side that their evidence says\n",
              100 * agreeing);
  return volume > 0 && agreeing > 0.8 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
