// SPDX-License-Identifier: Apache-2.0
// Writing the folder layout of MVSNet (Yao et al., ECCV 2018) and its many relatives:
//
//   cams/00000000_cam.txt      "extrinsic", 4×4 camera_from_world; "intrinsic", 3×3; 2 to 4 numbers: smallest
//                              depth, interval[, number of intervals[, largest depth]]
//   depth_est/00000000.pfm     z in the unit of the poses; 0, negative and non-finite: invalid
//   confidence/00000000.pfm    optional
//   images/00000000.png|jpg    optional
#pragma once

#include <cstddef>
#include <filesystem>

#include "vdbfuse/sensor/photograph.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Writes one view after the other; none stays in memory. Each file is complete or absent.
class MvsnetWriter {
 public:
  /// Creates the folder where it is missing. Throws IoError.
  explicit MvsnetWriter(std::filesystem::path folder);

  /// Writes the view as number size(). The line of depths holds its smallest and largest valid depth (0 when
  /// there are none) and 192 intervals. Confidence and colour are written when the view has them. Throws
  /// InvalidArgument when the projection is not a pinhole without distortion, or validate(view) objects;
  /// IoError when a file cannot be written.
  void add(const View& view);

  /// Writes a photograph as number size(): its camera and its picture in 8 bits, neither depth map nor mask.
  /// The line of depths holds what the photograph says, zeros when it says nothing. Throws as above.
  void add(const Photograph& photograph);

  /// Number of views written so far.
  std::size_t size() const { return count_; }

 private:
  std::filesystem::path folder_;
  std::size_t count_ = 0;
};

}  // namespace vdbfuse
