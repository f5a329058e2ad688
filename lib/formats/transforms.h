// SPDX-License-Identifier: Apache-2.0
// transforms.json of nerfstudio and instant-ngp, with depth maps or photographs alone:
//
//   fl_x, fl_y, cx, cy, w, h         for all frames, or in each; pixel centres at .5. fl_y is fl_x where it
//                                    is missing, cx and cy the middle, w and h the depth map's size
//   camera_angle_x, camera_angle_y   radians, in place of fl_x and fl_y
//   k1, k2, p1, p2, k3               optional; camera_model OPENCV, PINHOLE, ... but no fisheye
//   frames[].transform_matrix        4×4 or 3×4 world_from_camera, camera x right, y up, z backward
//   frames[].depth_file_path         (or depth_path) PNG, EXR, NPY, …, z; may be smaller than w×h
//   frames[].file_path               the picture; its extension may be missing
//   integer_depth_scale              (instant-ngp) unit of depth maps of whole numbers
//   depth_unit_scale_factor          unit of all depth maps. nerfstudio has it in its own configuration,
//   0.001
//                                    unless told otherwise, and multiplies floats by it, too; files state it,
//                                    where they do, for that reason. Floats without a stated unit are taken
//                                    as lengths, for scripts write them so.
//
//   frames[].mask_path               the mask of the photograph; with depth maps it is left out
//
// applied_transform and applied_scale tell how the poses were made and change nothing.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// `path` is the file, or a folder with transforms.json (or transforms_train.json). Throws IoError.
DepthSet readTransforms(const std::filesystem::path& path, const ReadOptions& options);

/// Writes transforms.json, depth/NAME.png of 16 bits and images/NAME.png. One step is WriteOptions'
/// depth_scale, else 0.001 where the largest depth lies between 1 and 65.534, else what makes it 65534
/// steps. The file states it for both programs (nerfstudio must be told).
void writeTransforms(const std::filesystem::path& folder, const ViewSequence& views,
                     const WriteOptions& options, const Progress& progress);

DepthSetFormat transformsFormat();

/// The pictures of the frames. `path` as above. Throws IoError.
ImageSet readTransformsImages(const std::filesystem::path& path, const ImageReadOptions& options);

/// transforms.json and images/.
void writeTransformsImages(const std::filesystem::path& folder, const PhotographSequence& photographs,
                           const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat transformsImageFormat();

}  // namespace vdbfuse
