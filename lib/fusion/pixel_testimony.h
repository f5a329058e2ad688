// SPDX-License-Identifier: Apache-2.0
// What the other views say of each pixel of a view, in a few bins.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "fusion/packed_normal.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/fusion/pixel_surface.h"
#include "vdbfuse/fusion/view_graph.h"
#include "vdbfuse/sensor/noise_model.h"

namespace vdbfuse {

/// Bins of one pixel. `measured` is false where there is no depth.
struct PixelTestimony {
  static constexpr std::size_t kAgreements = 6;      ///< neighbours that agree: 0 … 4, 5 or more
  static constexpr std::size_t kContradictions = 3;  ///< neighbours that see past the point: 0, 1, 2 or more
  /// Neighbours that the surface faces and that see something else, mostly nearer: 0 or 1, 2, 3 or 4, more.
  static constexpr std::size_t kOcclusions = 4;
  static constexpr std::size_t kMisses = 6;        ///< neighbours that met nothing there: 0 … 4, 5 or more
  static constexpr std::size_t kContinuities = 4;  ///< share of the neighbourhood on the same surface
  static constexpr std::size_t kDenials =
      7;  ///< smallest evidence of the others where this pixel claims free space
  /// What the neighbours answer: agreement and contradiction, or, where there is neither, occlusion and
  /// misses.
  static constexpr std::size_t kAnswers = kAgreements * kContradictions + kOcclusions * kMisses;

  // Two bytes.
  std::uint16_t agreement : 3 = 0, contradiction : 2 = 0, occlusion : 2 = 0, misses : 3 = 0,
                            continuity : 2 = 0;
  /// Not yet examined: the last bin, "nobody denies".
  std::uint16_t denial : 3 = kDenials - 1;
  std::uint16_t measured : 1 = false;

  std::size_t answer() const {
    if (agreement > 0 || contradiction > 0)
      return static_cast<std::size_t>(agreement) * kContradictions + contradiction;
    return kAgreements * kContradictions + static_cast<std::size_t>(occlusion) * kMisses + misses;
  }
};

static_assert(sizeof(PixelTestimony) == 2);

/// Calls visit(number of the pixel) where something was measured. Passes over the empty space around an
/// object eight pixels at a time.
template <class Visit>
void forEachMeasured(const Image<PixelTestimony>& testimony, const Visit& visit) {
  constexpr std::size_t kStep = 8;
  constexpr std::array<PixelTestimony, kStep> kNothing{};
  const PixelTestimony* pixels = testimony.data();
  for (std::size_t p = 0; p < testimony.size();) {
    const std::size_t end = std::min(p + kStep, testimony.size());
    if (end - p == kStep && std::memcmp(pixels + p, kNothing.data(), sizeof kNothing) == 0) p = end;
    for (; p < end; ++p) {
      if (pixels[p].measured) visit(p);
    }
  }
}

/// What judging keeps of the surface around each pixel (PixelSurface): nine bytes.
struct CompactSurface {
  Image<PackedNormal> normal;
  Image<std::uint8_t> continuity;  ///< bin
  Image<float> incidence;
};
/// analyseSurface() of a view, in its memory.
CompactSurface analyseCompactly(const View& view, const NoiseLaw& noise);
void letGo(const CompactSurface& surface);

struct Testimonies {
  std::vector<Image<PixelTestimony>> views;
  /// Share of no-returns where a point that three neighbours confirm should have been seen; ½ when unknown.
  double miss_rate = 0.5;
};

/// Asks the neighbours of each view. A neighbour agrees when its depth at the projected point is within 3
/// combined standard deviations and its normal within 45° (a missing normal vetoes nothing); it contradicts
/// when it measured something further away than that, or its mask says that the point is not of the object.
/// One that sees something nearer hides the point, which is strange where the surface faces it.
/// `alternatives`: for each neighbour other views that hold further hypotheses of its pixels; it agrees when
/// any of them does. Views beyond its end have none.
/// `order`: the views, those near each other together.
Testimonies hearNeighbours(const std::vector<View>& views, const std::vector<CompactSurface>& surfaces,
                           const SensorModel& sensor, const std::vector<std::vector<std::size_t>>& neighbours,
                           const std::vector<std::vector<std::size_t>>& alternatives,
                           const std::vector<std::size_t>& order, const Progress& progress);

}  // namespace vdbfuse
