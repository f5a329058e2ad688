// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/base/progress.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

struct ColorOptions {
  /// A view sees a vertex when its measurement is not further than this from it, in the unit of the poses:
  /// a few widths of the noise, or of the voxels. REQUIRES: > 0.
  double tolerance = 0;
};

struct ColorReport {
  std::size_t views = 0;    ///< that had a picture
  std::size_t colored = 0;  ///< vertices that some picture shows; the others take the colour next to them
};

/// Colours the vertices from the views' pictures: of those that show a vertex unoccluded, by their own
/// depths, the best six by angle and distance, and of these the weighted mean of what agrees with their
/// median, so that single mistakes and highlights do not count. Pictures are looked up between their pixels;
/// they may have a size and a sensor of their own. Vertices that no picture shows take the colour of those
/// around them; grey where there is none at all. Nothing happens when no view has a picture. Loads a few
/// views at a time. The same for every number of threads. REQUIRES: mesh.normals.
ColorReport colorVertices(const ViewSequence& views, const ColorOptions& options, TriangleMesh& mesh,
                          const Progress& progress = {});

}  // namespace vdbfuse
