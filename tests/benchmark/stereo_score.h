// SPDX-License-Identifier: Apache-2.0
// Depth maps from photographs of a synthetic scan, against its truth.
//
// A pixel counts when it sees the object, the pixels of the 7×7 window around it that do have a standard
// deviation of at least 3 grey levels, and its true point is in the picture of, and hidden by nothing from,
// at least two partners (one where there is but one). It is inside when the window sees one surface: no
// background and no step of more than 0.02 between neighbours. The error of a depth, in pixels, is the
// distance in a partner's picture between the images of the point at this depth and of the true one: the
// median over the partners, and that in the partner in whose picture the point moves most.
#pragma once

#include <cstddef>
#include <vector>

#include "vdbfuse/sensor/photograph.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse::benchmark {

/// A rendered scan and its photographs.
struct StereoScan {
  std::vector<SyntheticView> views;
  PhotographSequence photographs;
};
/// REQUIRES: the scan takes photographs.
StereoScan renderStereo(const SyntheticScan& scan);

/// Which pixels of a view count, and why others do not.
struct CountedPixels {
  enum class Kind : std::uint8_t { Background, Plain, Unseen, SeenOnce, Edge, Inside };
  Image<Kind> kind;
  Image<std::uint8_t> seen_by;  ///< partners that see the true point
  bool counts(int x, int y) const { return kind(x, y) >= Kind::Edge; }
};
CountedPixels countedPixels(const StereoScan& scan, std::size_t view,
                            const std::vector<std::size_t>& partners);

struct PixelError {
  double median = 0, widest = 0;
};
/// Of a depth at a pixel that sees the object.
PixelError pixelError(const StereoScan& scan, std::size_t view, const std::vector<std::size_t>& partners,
                      int x, int y, double depth);

/// Sums over views.
struct StereoScore {
  std::size_t pixels[6] = {};            ///< of each CountedPixels::Kind
  std::size_t invented = 0;              ///< background pixels with a depth
  std::vector<PixelError> edge, inside;  ///< of counted pixels that have a depth

  std::size_t of(CountedPixels::Kind kind) const { return pixels[static_cast<std::size_t>(kind)]; }
  std::size_t object() const;
  std::size_t counted() const { return of(CountedPixels::Kind::Edge) + of(CountedPixels::Kind::Inside); }
};
StereoScore& operator+=(StereoScore& sum, const StereoScore& other);
StereoScore score(const StereoScan& scan, std::size_t view, const std::vector<std::size_t>& partners,
                  const Image<float>& depth);

}  // namespace vdbfuse::benchmark
