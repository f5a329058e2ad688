// SPDX-License-Identifier: Apache-2.0
// Photographs with known cameras: what stereo makes depth maps from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// Depths z of what a photograph shows, unit of the poses.
struct DepthInterval {
  double near = 0, far = 0;
};

/// What is known of a photograph before it is loaded.
struct PhotographHeader {
  std::string name;
  Pinhole camera;  ///< without distortion
  RigidTransform world_from_camera = RigidTransform::Identity();
  std::optional<DepthInterval> depth = std::nullopt;  ///< where the data set says, or its sparse points do
};

/// All images have the size of the camera, or are empty.
struct Photograph : PhotographHeader {
  Image<float> brightness;   ///< in [0, 1], as stored (not linearised)
  Image<Rgb8> color;         ///< empty: the photograph is grey
  Image<std::uint8_t> mask;  ///< silhouette: non-zero where the pixel sees the object; empty: unknown
};

/// 0.299 R + 0.587 G + 0.114 B over `white` (ITU-R BT.601), added up in whole numbers: equal parts give
/// exactly their share of white.
float brightnessOf(std::uint32_t red, std::uint32_t green, std::uint32_t blue, std::uint32_t white);
float brightnessOf(const Rgb8& color);
/// The same of a whole picture.
Image<float> brightnessOf(const Image<Rgb8>& color);
/// The nearest of 256 steps to a brightness in [0, 1]; what lies beyond becomes the first or the last.
std::uint8_t greyLevel(float brightness);

/// Everything that is wrong with a photograph, one sentence each: camera, pose, image sizes, depths.
std::vector<std::string> validate(const Photograph& photograph);

/// Knows every camera; loads pictures on demand and keeps none.
class PhotographSequence {
 public:
  /// Loads the pictures of number `index` into an object whose header is set. Called from several threads at
  /// once. Throws IoError.
  using Loader = std::function<void(std::size_t index, Photograph& photograph)>;

  PhotographSequence() = default;
  PhotographSequence(std::vector<PhotographHeader> headers, Loader loader);
  /// Photographs that are in memory already. Each load() copies one.
  static PhotographSequence fromPhotographs(std::vector<Photograph> photographs);

  std::size_t size() const { return headers_.size(); }
  bool empty() const { return headers_.empty(); }
  const PhotographHeader& header(std::size_t index) const { return headers_[index]; }
  /// Throws IoError when a file cannot be read, InvalidArgument (naming the photograph) when
  /// validate(photograph) objects.
  Photograph load(std::size_t index) const;
  /// The first `count` photographs, or all of them when there are fewer.
  PhotographSequence first(std::size_t count) const;

 private:
  std::vector<PhotographHeader> headers_;
  Loader loader_;
};

}  // namespace vdbfuse
