// SPDX-License-Identifier: Apache-2.0
// What every reader does with the options and with the images it finds.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// How stored numbers become depth: as asked for, else `kind`, with `length_scale` for lengths and 1 for the
/// others. Throws InvalidArgument when disparity is asked for and the projection is no pinhole or the
/// baseline missing.
DepthEncoding encodingFor(const ReadOptions& options, const Projection& projection, DepthKind kind,
                          double length_scale);

/// toSensorDepth(), and depths outside [min_depth, max_depth] become invalid.
Image<float> sensorDepth(Image<float> stored, const Projection& projection, const DepthEncoding& encoding,
                         const ReadOptions& options);

/// For formats of points: lengths as asked for, and what is outside [min_depth, max_depth] becomes invalid.
/// `depth` is in the sensor's own measure.
void limitPointDepth(Image<float>& depth, const ReadOptions& options);

/// Throws InvalidArgument when the options ask for what only depth maps have: a kind other than `natural`, or
/// intrinsics. `format` names the format.
void requirePointOptions(const ReadOptions& options, DepthKind natural, const std::string& format);

/// A PNG or JPEG file, told apart by its extension.
Image<Rgb8> readPicture(const std::filesystem::path& path);

/// Its width and height, from its header.
std::pair<int, int> pictureSize(const std::filesystem::path& path);

}  // namespace vdbfuse
