// SPDX-License-Identifier: Apache-2.0
// The images of a view, kept small without losing a bit.
#pragma once

#include <memory>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Sensors measure in steps: few different depths, though many pixels. Where there are at most 65536 of them,
/// and half as many as pixels, a pixel is the number of its depth in a table.
class PackedImages {
 public:
  /// A copy of the images that lies in `memory`, which is kept alive. In ScratchMemory the pixels are let go
  /// of at once. Throws what `memory` throws.
  PackedImages(const DepthMap& map, std::shared_ptr<std::pmr::memory_resource> memory);

  /// What was packed, in plain memory.
  DepthMap unpack() const;
  std::size_t bytes() const;

 private:
  std::shared_ptr<std::pmr::memory_resource> memory_;  ///< outlives the images
  Image<float> table_;                                 ///< one row; empty: rest_ has the depths as they were
  Image<std::uint16_t> codes_;
  DepthMap rest_;
};

}  // namespace vdbfuse
