// SPDX-License-Identifier: Apache-2.0
// The files of a COLMAP model, written.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// The first line of points3D.txt.
inline constexpr char kColmapPointTitle[] =
    "# POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n";

/// What is written about a view.
struct ColmapView {
  std::string file;
  Pinhole camera;  ///< of the picture
  RigidTransform world_from_camera;
};

/// cameras.txt, images.txt and points3D.txt. `seen` are the views' lines of points.
void writeColmapText(const std::filesystem::path& folder, const std::vector<ColmapView>& views,
                     const std::vector<std::string>& seen, const std::string& points);

/// cameras.bin, images.bin and points3D.bin, without points.
void writeColmapBinary(const std::filesystem::path& folder, const std::vector<ColmapView>& views);

}  // namespace vdbfuse
