// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vdbfuse::test {

/// Little-endian floats.
std::string floatBytes(const std::vector<float>& values);

/// The dense scans of the tiny scene as a sequence of KITTI: velodyne/*.bin and poses.txt; with a camera and
/// its calib.txt, or with the poses of the laser itself.
void writeKittiOfCamera(const std::filesystem::path& folder);
void writeKittiOfLaser(const std::filesystem::path& folder);

}  // namespace vdbfuse::test
