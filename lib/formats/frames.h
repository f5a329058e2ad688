// SPDX-License-Identifier: Apache-2.0
// Data sets whose images are files of their own: what all such formats have in common.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// One view: what its camera files say, and where its images lie (empty path: none).
struct Frame {
  /// The size of its pinhole is that of the images it was made for, or 0 where the format does not say. Its
  /// principal point counts from the centre of the first pixel.
  ViewHeader header;
  std::filesystem::path depth;       ///< any kind of raster (io/raster.h)
  std::filesystem::path confidence;  ///< the same, of the size of the depth map
  std::filesystem::path color;       ///< PNG or JPEG of any size
};

/// What a format says of the numbers in its depth maps; ReadOptions override it.
struct FrameFormat {
  double integer_scale = 0.001;  ///< unit of whole numbers, in lengths
  double float_scale = 1.0;      ///< unit of floats
  DepthKind kind = DepthKind::Z;
  std::string pose = "4x4 world_from_camera, x right, y down, z forward";
  /// DepthSet::stored_from_camera, the same for all.
  RigidTransform stored_from_camera = RigidTransform::Identity();
};

/// Axes of OpenGL's cameras (x right, y up, z backward) from ours, and ours from them.
RigidTransform openGlFromCamera();

/// Reads the sizes of all images now, and their pixels when they are asked for. Cameras are brought to the
/// size of their depth maps. Notes say for how many views there is colour, and where a principal point lies
/// outside. Throws IoError: there are no frames, an image is missing or of the wrong kind or size.
DepthSet setOfFrames(const std::filesystem::path& input, std::vector<Frame> frames, const FrameFormat& format,
                     const ReadOptions& options);

/// The camera for images of another size: every direction falls on the same part of the image.
Pinhole resized(const Pinhole& camera, int width, int height);

/// A camera with fy < 0 is left-handed: both its frame and the world's have y up. This is the same set with
/// both turned into right-handed frames by changing the sign of y.
void makeRightHanded(ViewHeader& header);

}  // namespace vdbfuse
