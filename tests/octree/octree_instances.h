// SPDX-License-Identifier: Apache-2.0
// Seeded octrees around a bumpy ball, with evidence like that of scans: minimum cuts of the real shape,
// without a scan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mincut/instances.h"
#include "vdbfuse/octree/graph.h"

namespace vdbfuse::test {

enum class OctreeFamily {
  Carving,   ///< free space strong, the inside only a weak ballooning
  Seeds,     ///< evidence only far from the surface: long paths
  OneSided,  ///< seen from one side; what is behind the surface is weakly inside, its faces at their highest
};
inline constexpr OctreeFamily kOctreeFamilies[] = {OctreeFamily::Carving, OctreeFamily::Seeds,
                                                   OctreeFamily::OneSided};
std::string name(OctreeFamily family);

struct OctreeInstance {
  Octree octree;
  CellTiles tiles;
  std::vector<float> support, sigma;
  CutOptions options;

  /// Refers to this instance.
  NetworkSource source() const { return cutSource(octree, tiles, support, sigma, options); }
  Instance graph() const { return listAllEdges(source()); }
};

/// Of `resolution` finest voxels a side.
OctreeInstance octreeInstance(OctreeFamily family, int resolution, std::uint64_t seed);

}  // namespace vdbfuse::test
