// SPDX-License-Identifier: Apache-2.0
// Tiny sets of photographs of every format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/samples.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::test {

/// Four photographs of 24×18 pixels with the poses of tinyViews(): one focal length, the principal point in
/// the middle, depths 1.4 to 3. The third is grey with 16 bits, the second has a mask.
std::vector<Photograph> tinyPhotographs();

/// Points of the tiny scene, all of which the tiny views see.
std::vector<Eigen::Vector3d> tinyPoints();

/// The cameras of tinyPhotographs() with points and distortion, as their own programs write them; beside the
/// pictures photographs/0.png, ...
void writeBundlerSample(const std::filesystem::path& folder);
void writeNvmSample(const std::filesystem::path& folder);
/// Binary, cameras with k1, and points.
void writeColmapPointsSample(const std::filesystem::path& folder);

/// At least one of every format of imageSetFormats(); `input` is handed to readImageSet().
const std::vector<Sample>& imageSamples();

}  // namespace vdbfuse::test
