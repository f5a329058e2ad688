// SPDX-License-Identifier: Apache-2.0
// What a .sens file holds, and the images of its frames.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

struct SensCamera {
  Eigen::Matrix4d intrinsics, extrinsics;
  int width = 0, height = 0;  ///< 0×0: no pictures
  std::uint64_t intrinsics_byte = 0;
};

struct SensFrame {
  Eigen::Matrix4d world_from_camera;
  std::uint64_t begin = 0;  ///< byte of the frame
  std::uint64_t color_begin = 0, color_bytes = 0;
  std::uint64_t depth_begin = 0, depth_bytes = 0;
};

enum class SensColor { Raw = 0, Png = 1, Jpeg = 2, Other };
enum class SensDepth { Raw = 0, Zlib = 1 };

struct SensFile {
  std::filesystem::path path;
  SensCamera color, depth;
  SensColor color_compression = SensColor::Other;
  SensDepth depth_compression = SensDepth::Raw;
  double depth_shift = 1000;
  std::vector<SensFrame> frames;
};

/// Reads the header and goes from frame to frame. Throws IoError.
SensFile indexSens(const std::filesystem::path& path);

/// The numbers as stored, 65535 made 0. Throws IoError when they are more or fewer than the size says.
Image<float> readSensDepth(const SensFile& file, const SensFrame& frame);
/// Empty where the frame has none. Throws IoError. REQUIRES: the compression is not Other.
Image<Rgb8> readSensColor(const SensFile& file, const SensFrame& frame);

}  // namespace vdbfuse
