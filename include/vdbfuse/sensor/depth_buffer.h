// SPDX-License-Identifier: Apache-2.0
// Depth that a caller has in memory, in whatever measure and layout, made into a DepthMap.
#pragma once

#include <cstddef>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// What a stored number measures, after it has been multiplied by the scale.
enum class DepthKind {
  Z,          ///< distance along the z axis of the camera
  Range,      ///< distance along the pixel's ray from where the ray starts (z = 0)
  Disparity,  ///< pixels: z = focal_baseline / disparity
  Inverse,    ///< 1/length: z = 1 / value
};

/// How stored numbers become depth.
struct DepthEncoding {
  DepthKind kind = DepthKind::Z;
  double scale = 1.0;           ///< stored number × scale is the measure above, > 0
  double focal_baseline = 0.0;  ///< focal length [px] × baseline [length], for Disparity only, > 0
};

/// Depth in the sensor's own measure (geometry/projection.h): every projection's points are start + depth·v
/// along the ray of a pixel, so depth = z / v.z and depth = range / |v|. Non-finite, zero and negative
/// numbers become kInvalidDepth, and so does a z that a ray with v.z ≤ 0 cannot have. Throws InvalidArgument
/// when the image is not of the projection's size or the encoding is impossible.
Image<float> toSensorDepth(Image<float> stored, const Projection& projection, const DepthEncoding& encoding);

/// Depth in the caller's memory; it is read once and never kept.
struct DepthBuffer {
  enum class Type {
    Float32,
    UInt16,  ///< 0 and 65535 (saturated) are invalid
  };
  const void* data = nullptr;  ///< first byte of the top row
  Type type = Type::Float32;
  int width = 0, height = 0;  ///< pixels
  std::ptrdiff_t row_stride =
      0;  ///< bytes from a row to the one below it, negative when stored upside down; 0: packed
  DepthEncoding encoding;
};

/// The depth map of a buffer, without confidence and colour. No alignment is needed.
/// Throws InvalidArgument when the buffer does not fit the projection.
DepthMap importDepth(const DepthBuffer& buffer, const Projection& projection);

}  // namespace vdbfuse
