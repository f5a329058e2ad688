// SPDX-License-Identifier: Apache-2.0
// What every reader does with the options and with the images it finds.
#pragma once

#include <filesystem>

#include "vdbfuse/io/depth_set.h"

namespace vdbfuse {

/// How stored numbers become depth: as asked for, else z with `length_scale` for lengths and 1 for the
/// others. Throws InvalidArgument when disparity is asked for and the projection is no pinhole or the
/// baseline missing.
DepthEncoding encodingFor(const ReadOptions& options, const Projection& projection, double length_scale);

/// toSensorDepth(), and depths outside [min_depth, max_depth] become invalid.
Image<float> sensorDepth(Image<float> stored, const Projection& projection, const DepthEncoding& encoding,
                         const ReadOptions& options);

/// A PNG or JPEG file, told apart by its extension.
Image<Rgb8> readPicture(const std::filesystem::path& path);

}  // namespace vdbfuse
