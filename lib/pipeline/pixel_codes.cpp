// SPDX-License-Identifier: Apache-2.0
#include "pipeline/pixel_codes.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

constexpr std::uint16_t kNothing = 0, kOutside = 65534, kEmpty = 65535;
constexpr double kEven = 32767, kSteps = 32766, kLargestLogOdds = 16;

std::uint16_t codeOf(float outlier) {
  const double odds = std::log(static_cast<double>(outlier)) - std::log1p(-static_cast<double>(outlier));
  const double place = std::clamp(odds / kLargestLogOdds, -1.0, 1.0);
  return static_cast<std::uint16_t>(std::lround(kEven + kSteps * place));
}

float outlierOf(std::uint16_t code) {
  return static_cast<float>(1 / (1 + std::exp(-kLargestLogOdds * (code - kEven) / kSteps)));
}

Look lookOf(std::uint16_t code) {
  return code == kOutside ? Look::Outside : code == kEmpty ? Look::Empty : Look::Nothing;
}

}  // namespace

Image<std::uint16_t> encodePixels(const JudgedView& view) {
  Image<std::uint16_t> codes(view.depth.width(), view.depth.height(), kNothing);
  for (std::size_t p = 0; p < codes.size(); ++p) {
    const Look look = view.look.data()[p];
    std::uint16_t& code = codes.data()[p];
    if (look == Look::Outside) {
      code = kOutside;
    } else if (view.depth.data()[p] != kInvalidDepth) {
      code = codeOf(view.outlier.data()[p]);
    } else if (look == Look::Empty) {
      code = kEmpty;
    }
  }
  return codes;
}

void decodePixels(const Image<std::uint16_t>& codes, JudgedView& view) {
  for (std::size_t p = 0; p < codes.size(); ++p) {
    const std::uint16_t code = codes.data()[p];
    const bool measured = code != kNothing && code != kOutside && code != kEmpty;
    view.look.data()[p] = lookOf(code);
    view.outlier.data()[p] = measured ? outlierOf(code) : kMaxOutlier;
    if (!measured) view.depth.data()[p] = kInvalidDepth;
  }
}

Image<std::uint8_t> reliabilityImage(const JudgedView& view) {
  Image<std::uint8_t> image(view.depth.width(), view.depth.height());
  for (std::size_t p = 0; p < image.size(); ++p) {
    if (view.depth.data()[p] == kInvalidDepth || view.look.data()[p] == Look::Outside) continue;
    image.data()[p] = static_cast<std::uint8_t>(std::lround(255 * (1 - view.outlier.data()[p])));
  }
  return image;
}

}  // namespace vdbfuse
