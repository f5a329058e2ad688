// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare: from where all methods' meshes are drawn.
#pragma once

#include <string>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse::tool {

struct NamedCamera {
  std::string file;   ///< part of names of files
  std::string words;  ///< in captions
  ViewHeader view;
};

/// What points up: an axis by its name; of 'auto' the mean of the views' upward directions, or the coordinate
/// axis that is within 20° of it; +z where they have none in common.
Eigen::Vector3d chooseUp(const std::string& name, const std::vector<ViewHeader>& views);

struct CameraList {
  std::vector<NamedCamera> all;
  std::size_t front_index = 0;
  const NamedCamera& front() const { return all[front_index]; }
  /// The view's, where there is one, else the last.
  const NamedCamera& other() const { return front_index > 0 ? all.front() : all.back(); }
};

/// Three around `mesh`, the front being the side where the sensors were; and, before them, that of the middle
/// view where the views are those of pinhole cameras.
CameraList chooseCameras(const TriangleMesh& mesh, const std::vector<ViewHeader>& views,
                         const Eigen::Vector3d& up);

}  // namespace vdbfuse::tool
