// SPDX-License-Identifier: Apache-2.0
// Reads with plain OpenVDB, and nothing of vdbfuse, what `vdbfuse fuse --save-grids FILE.vdb` wrote.
//   example_08_read_vdb FILE.vdb
// Lists the grids, measures the level set `surface`, and asks `sigma` which side of the surface each voxel is
// on.
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

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
  std::printf("surface: %zu points, %zu quads, volume %.4f\n", points.size(), quads.size(),
              -six_times / 6);  // OpenVDB's polygons are clockwise seen from outside
  return -six_times / 6;
}

/// Share of the voxels behind the surface that the evidence calls inside (σ < 0), and of those before it that
/// it calls outside.
double agreement(const FloatGrid& surface, const FloatGrid& sigma) {
  const FloatGrid::ConstAccessor evidence = sigma.getConstAccessor();
  std::size_t seen = 0, agree = 0;
  for (FloatGrid::ValueOnCIter voxel = surface.cbeginValueOn(); voxel; ++voxel) {
    float value = 0;
    if (!evidence.probeValue(voxel.getCoord(), value)) continue;  // nothing is known there
    ++seen;
    agree += (*voxel > 0) == (value > 0);
  }
  return seen == 0 ? 0 : static_cast<double>(agree) / static_cast<double>(seen);
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
  std::printf("sigma: %.1f %% of the voxels around the surface are on the side that the evidence says\n",
              100 * agreeing);
  return volume > 0 && agreeing > 0.5 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
