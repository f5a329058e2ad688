// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/depth_buffer.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <variant>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

void checkEncoding(const DepthEncoding& encoding) {
  if (!(encoding.scale > 0 && std::isfinite(encoding.scale))) {
    throw InvalidArgument("scale", "expected a number above 0, found " + std::to_string(encoding.scale));
  }
  if (encoding.kind != DepthKind::Disparity) return;
  if (!(encoding.focal_baseline > 0 && std::isfinite(encoding.focal_baseline))) {
    throw InvalidArgument("focal_baseline", "disparity needs focal length × baseline above 0, found " +
                                                std::to_string(encoding.focal_baseline));
  }
}

void checkSize(const char* argument, int width, int height, const Projection& projection) {
  if (width == imageWidth(projection) && height == imageHeight(projection)) return;
  throw InvalidArgument(argument, "expected " + std::to_string(imageWidth(projection)) + "x" +
                                      std::to_string(imageHeight(projection)) + " pixels, found " +
                                      std::to_string(width) + "x" + std::to_string(height));
}

// A ray's points are start + depth·v, linear in depth for every projection.
Eigen::Vector3d rayPerDepth(const Projection& projection, int x, int y) {
  return unproject(projection, x, y, 2.0) - unproject(projection, x, y, 1.0);
}

// z, or the range, of one stored number; infinite where there is none.
double measured(double value, const DepthEncoding& encoding) {
  switch (encoding.kind) {
    case DepthKind::Z:
    case DepthKind::Range:
      return value;
    case DepthKind::Disparity:
      return encoding.focal_baseline / value;
    case DepthKind::Inverse:
      return 1.0 / value;
  }
  return value;
}

float usable(double depth) {
  const auto result = static_cast<float>(depth);
  return std::isfinite(result) && result > 0 ? result : kInvalidDepth;
}

// Whether z is the projection's own measure, so that no ray is needed.
bool measuresZ(const Projection& projection) { return !std::holds_alternative<Spherical>(projection); }

template <class T>
T load(const std::byte* address) {
  T value;
  std::memcpy(&value, address, sizeof(T));
  return value;
}

float storedValue(const std::byte* row, int x, DepthBuffer::Type type) {
  if (type == DepthBuffer::Type::Float32)
    return load<float>(row + sizeof(float) * static_cast<std::size_t>(x));
  const auto value = load<std::uint16_t>(row + sizeof(std::uint16_t) * static_cast<std::size_t>(x));
  return value == std::numeric_limits<std::uint16_t>::max() ? kInvalidDepth : static_cast<float>(value);
}

}  // namespace

Image<float> toSensorDepth(Image<float> stored, const Projection& projection, const DepthEncoding& encoding) {
  checkSize("stored", stored.width(), stored.height(), projection);
  checkEncoding(encoding);
  const bool along_ray = encoding.kind == DepthKind::Range;
  const bool needs_ray = along_ray || !measuresZ(projection);
  for (int y = 0; y < stored.height(); ++y) {
    for (int x = 0; x < stored.width(); ++x) {
      float& pixel = stored(x, y);
      const double value = pixel * encoding.scale;
      double depth = std::isfinite(value) && value > 0 ? measured(value, encoding) : 0.0;
      if (needs_ray && depth > 0) {
        const Eigen::Vector3d v = rayPerDepth(projection, x, y);
        depth /= along_ray ? v.norm() : v.z();
      }
      pixel = usable(depth);
    }
  }
  return stored;
}

DepthMap importDepth(const DepthBuffer& buffer, const Projection& projection) {
  if (buffer.data == nullptr) throw InvalidArgument("data", "expected an address, found none");
  checkSize("buffer", buffer.width, buffer.height, projection);
  const std::size_t pixel_bytes =
      buffer.type == DepthBuffer::Type::Float32 ? sizeof(float) : sizeof(std::uint16_t);
  const auto row_bytes = static_cast<std::ptrdiff_t>(pixel_bytes) * buffer.width;
  const std::ptrdiff_t stride = buffer.row_stride == 0 ? row_bytes : buffer.row_stride;
  if (std::abs(stride) < row_bytes) {
    throw InvalidArgument("row_stride", "expected at least " + std::to_string(row_bytes) + " bytes, found " +
                                            std::to_string(stride));
  }
  Image<float> stored(buffer.width, buffer.height);
  const auto* first = static_cast<const std::byte*>(buffer.data);
  for (int y = 0; y < buffer.height; ++y) {
    const std::byte* row = first + y * stride;
    for (int x = 0; x < buffer.width; ++x) stored(x, y) = storedValue(row, x, buffer.type);
  }
  DepthMap map;
  map.depth = toSensorDepth(std::move(stored), projection, buffer.encoding);
  return map;
}

}  // namespace vdbfuse
