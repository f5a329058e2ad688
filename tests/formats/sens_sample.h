// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse::test {

/// What goes into a .sens file; depth in millimetres, colour of the views' own size.
struct SensRecording {
  std::vector<View> views;
  int color = 2;  ///< 0 raw, 1 PNG, 2 JPEG
  int depth = 1;  ///< 0 raw, 1 zlib
  Eigen::Matrix4f color_intrinsics = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f color_extrinsics = Eigen::Matrix4f::Identity();
  Eigen::Matrix4f depth_extrinsics = Eigen::Matrix4f::Identity();
};

/// The tiny scene, its colour camera the same as that of the depth.
SensRecording tinyRecording(int color, int depth);

/// Byte by byte.
std::string sensBytes(const SensRecording& recording);

}  // namespace vdbfuse::test
