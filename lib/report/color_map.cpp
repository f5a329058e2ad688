// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/color_map.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace vdbfuse {
namespace {

constexpr Rgb8 kDiverging[] = {
    {24, 62, 140}, {110, 160, 215}, {250, 250, 248}, {232, 142, 110}, {150, 20, 36}};
constexpr Rgb8 kSequential[] = {{34, 24, 82},   {44, 74, 132},  {32, 126, 138},
                                {66, 176, 112}, {176, 214, 62}, {252, 240, 90}};

// Colour at `position` ∈ [0, 1] along evenly spaced stops.
Rgb8 between(std::span<const Rgb8> stops, double position) {
  const double x = std::clamp(position, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), stops.size() - 2);
  const double share = x - static_cast<double>(i);
  Rgb8 color;
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(std::lround((1 - share) * stops[i][c] + share * stops[i + 1][c]));
  return color;
}

}  // namespace

Rgb8 divergingColor(double value) { return between(kDiverging, 0.5 * (value + 1)); }

Rgb8 sequentialColor(double value) { return between(kSequential, value); }

}  // namespace vdbfuse
