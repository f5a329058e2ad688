// SPDX-License-Identifier: Apache-2.0
// From a signed field to triangles. One extractor for the cut and for the TSDF, so that a comparison compares
// evidence.
#pragma once

#include "vdbfuse/base/progress.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The surface where `field` changes sign (> 0 outside; 0 counts as outside). Marching cubes over the cubes
/// between voxels, with one rule for ambiguous faces (the inside is joined) and polygons triangulated so that
/// no diagonal lies in a face: for every possible field the mesh is edge- and vertex-manifold and
/// consistently oriented, and it is closed where all voxels around the surface are known. Cubes with an
/// unknown corner are left out: an open rim (whose fans never touch in a vertex). Missing leaves are unknown.
/// Welded; the same for any number of threads. World coordinates.
TriangleMesh extractSurface(const ScalarGrid& field, const Progress& progress = {});

}  // namespace vdbfuse
