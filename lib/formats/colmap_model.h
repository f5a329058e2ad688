// SPDX-License-Identifier: Apache-2.0
// What of a COLMAP model says where depth maps were taken: cameras, images, and (since COLMAP 3.12) rigs and
// frames, each as .bin or .txt; and what its points say about depths.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {

struct ColmapImage {
  std::uint32_t id = 0;
  std::uint32_t camera = 0;
  RigidTransform camera_from_world = RigidTransform::Identity();
  std::string name;  ///< with its extension, and maybe folders; not checked to be inside of any
};

struct ColmapModel {
  std::filesystem::path images_file;         ///< where the names stand
  std::map<std::uint32_t, Pinhole> cameras;  ///< centres at integers
  std::vector<ColmapImage> images;           ///< by name
  std::size_t moved = 0;  ///< images whose frame gives another pose than images.* does; the frame's is taken
};

/// Whether the folder holds cameras and images.
bool hasColmapModel(const std::filesystem::path& folder);

/// Throws IoError: a file is missing or broken, a camera is of a model that is no pinhole with distortion of
/// up to five coefficients, a quaternion is not of length 1, an image has no camera.
ColmapModel readColmapModel(const std::filesystem::path& folder);

/// Of each image of the model the depths that points3D.bin or .txt gives it, see SparseDepths; all empty
/// where there is no such file. Throws IoError.
std::vector<std::optional<DepthInterval>> readColmapDepths(const std::filesystem::path& folder,
                                                           const ColmapModel& model);

}  // namespace vdbfuse
