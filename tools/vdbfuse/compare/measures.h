// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare: how far the methods' meshes are from the truth, or from each other.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/methods.h"

namespace vdbfuse::tool {

/// A method's mesh with what it is coloured by.
struct ShownMesh {
  std::string name;
  TriangleMesh mesh;
  std::vector<float> distances;  ///< of its vertices: see MeasuredMeshes; empty when it is the only one
  std::vector<float> missing;    ///< of the reference's vertices from this mesh; empty without a reference
};

struct MeasuredMeshes {
  TriangleMesh reference;  ///< empty: there is none
  std::vector<ShownMesh> meshes;
  /// What distances are measured from: "the reference", or "the other mesh" (the first, of the others).
  std::string measured_from;
  /// At the light ends of the colours, two digits. Of the mesh whose distances are smallest 90 % of the area
  /// lies below a third of the distance (which is a voxel at least); of every mesh 98 % lies below the
  /// support.
  double largest_distance = 1, largest_support = 1;
};

/// Reads the meshes back from `folder` and measures them; with a reference the records get their evaluations.
/// Throws IoError, InvalidArgument.
MeasuredMeshes measureMeshes(const CompareRequest& request, const std::filesystem::path& folder,
                             TriangleMesh reference, CompareRun& run, const Progress& progress);

/// How the page shows a length: three digits.
std::string lengthText(double length);

}  // namespace vdbfuse::tool
