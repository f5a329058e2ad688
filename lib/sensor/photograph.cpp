// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/photograph.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/distortion.h"

namespace vdbfuse {

float brightnessOf(std::uint32_t red, std::uint32_t green, std::uint32_t blue, std::uint32_t white) {
  const std::uint64_t sum = 299 * std::uint64_t{red} + 587 * std::uint64_t{green} + 114 * std::uint64_t{blue};
  return static_cast<float>(static_cast<double>(sum) / (1000.0 * white));
}

float brightnessOf(const Rgb8& color) { return brightnessOf(color[0], color[1], color[2], 255); }

Image<float> brightnessOf(const Image<Rgb8>& color) {
  Image<float> brightness(color.width(), color.height());
  std::transform(color.begin(), color.end(), brightness.begin(),
                 [](const Rgb8& pixel) { return brightnessOf(pixel); });
  return brightness;
}

std::uint8_t greyLevel(float brightness) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(brightness, 0.0F, 1.0F)));
}

std::vector<std::string> validate(const Photograph& photograph) {
  std::vector<std::string> problems = validate(Projection(photograph.camera));
  const auto fits = [&](const auto& image) {
    return image.width() == photograph.camera.width && image.height() == photograph.camera.height;
  };
  if (isDistorted(photograph.camera)) problems.emplace_back("the picture must be undistorted");
  if (!photograph.world_from_camera.matrix().allFinite()) problems.emplace_back("the pose must be finite");
  if (!fits(photograph.brightness)) problems.emplace_back("the picture must have the size of its camera");
  if (!photograph.color.empty() && !fits(photograph.color))
    problems.emplace_back("the colours must have the size of the camera");
  if (!photograph.mask.empty() && !fits(photograph.mask))
    problems.emplace_back("the mask must have the size of the camera");
  if (photograph.depth && !(photograph.depth->near > 0 && photograph.depth->far > photograph.depth->near &&
                            std::isfinite(photograph.depth->far)))
    problems.emplace_back("the depths must be an interval above 0");
  return problems;
}

PhotographSequence::PhotographSequence(std::vector<PhotographHeader> headers, Loader loader)
    : headers_(std::move(headers)), loader_(std::move(loader)) {}

PhotographSequence PhotographSequence::fromPhotographs(std::vector<Photograph> photographs) {
  std::vector<PhotographHeader> headers(photographs.begin(), photographs.end());
  auto shared = std::make_shared<const std::vector<Photograph>>(std::move(photographs));
  return {std::move(headers),
          [shared](std::size_t index, Photograph& photograph) { photograph = (*shared)[index]; }};
}

Photograph PhotographSequence::load(std::size_t index) const {
  Photograph photograph;
  static_cast<PhotographHeader&>(photograph) = headers_[index];
  loader_(index, photograph);
  const std::vector<std::string> problems = validate(photograph);
  if (!problems.empty()) throw InvalidArgument("photograph " + photograph.name, problems.front());
  return photograph;
}

PhotographSequence PhotographSequence::first(std::size_t count) const {
  PhotographSequence result = *this;
  result.headers_.resize(std::min(count, size()));
  return result;
}

}  // namespace vdbfuse
