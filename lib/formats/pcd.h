// SPDX-License-Identifier: Apache-2.0
// Organised point clouds of the Point Cloud Library: one .pcd file, or a folder of them, a view each.
//
// Ascii, binary or compressed; x, y and z as 4-byte floats; more than one row; VIEWPOINT is
// world_from_camera. The camera is not stored: it is the pinhole that fits the points
// (sensor/organised_points.h). Points are in the sensor's frame; where only taking them back by VIEWPOINT
// makes them fit a camera, they were in the world's, and a note says so.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads every file once to find its camera, and again when its image is asked for; views are ordered by
/// name. The library vdbfuse_pcl is opened when the first file is read, and not before. Throws IoError: the
/// library is missing, a header is unsound, data are short, or no camera fits.
DepthSet readPcd(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat pcdFormat();

}  // namespace vdbfuse
