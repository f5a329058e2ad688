// SPDX-License-Identifier: Apache-2.0
// An interactive viewer as a part of a page: meshes side by side under one camera (three.js, WebGL).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Whether three.js was there when the library was built (Debian's libjs-three).
enum class ViewerScript { Included, Missing };
ViewerScript viewerScriptState();

/// Colours that every mesh can take on. Names of VertexValues in its glb, or empty: there are none.
struct ViewerColoring {
  std::string label;      ///< on the button
  std::string attribute;  ///< as in the glb, "_SUPPORT"
  double high = 1;        ///< what the light end of the colours stands for; the dark end is 0
  /// Values below are orange: no measurement.
  double orange_below = 0;
  std::string low_words, high_words;  ///< at the ends of the colours
};

struct ViewerMesh {
  std::string name;
  std::string glb;    ///< glbBytes()
  std::string words;  ///< below the name
};

/// Where the camera begins, world coordinates.
struct ViewerCamera {
  Eigen::Vector3d eye, target, up;
};

/// Scripts, meshes and places to draw. Without three.js: a paragraph that says so. Where the browser has no
/// WebGL the page says so, too. The page's element gets the attributes data-viewer (loading, drawn or failed)
/// and, once drawn, data-variance: that of the brightness in each mesh's place, 0 … 65025.
std::string viewerHtml(const std::vector<ViewerMesh>& meshes, const std::vector<ViewerColoring>& colorings,
                       const ViewerCamera& camera);

/// The notice that goes with three.js; empty where it is missing.
std::string viewerLicence();

}  // namespace vdbfuse
