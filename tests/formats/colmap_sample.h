// SPDX-License-Identifier: Apache-2.0
// Dense workspaces of COLMAP spelt out.
#pragma once

#include <filesystem>
#include <string>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse::test {

/// "camera_from_world" of the view as a quaternion w x y z and a translation.
std::string colmapPose(const RigidTransform& pose);
/// The depth map as "24&18&1&" and floats.
std::string colmapMap(const Image<float>& depth);

/// Text in sparse/0, one camera for all images, which are twice as large as the depth maps.
void writeColmapTextSample(const std::filesystem::path& folder);
/// Binary in sparse, as COLMAP 3.12 writes it: a rig of two cameras of other models, three frames, names in
/// folders; one depth map is photometric. Images see points.
void writeColmapRigSample(const std::filesystem::path& folder);

}  // namespace vdbfuse::test
