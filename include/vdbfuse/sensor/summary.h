// SPDX-License-Identifier: Apache-2.0
// What is in a sequence of views: how far, how much, where.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

struct SummaryOptions {
  /// Share of the values that `low`, `high` and the box of the points leave out at each end, in [0, 0.5). A
  /// few wild depths must not say how large the scene is.
  double tail = 0.002;
  /// Quantiles are taken over about this many valid pixels, spread evenly; more cost memory (20 bytes each),
  /// fewer blur the tails. Smallest and largest values and counts are exact.
  std::size_t samples = 2'000'000;
};

struct Spread {
  double smallest = 0, low = 0, median = 0, high = 0, largest = 0;
};

struct ViewsSummary {
  std::size_t views = 0;
  std::size_t views_with_confidence = 0;
  std::size_t views_with_color = 0;
  std::uint64_t pixels = 0;
  std::uint64_t valid_pixels = 0;
  /// In the sensors' measures; nothing when no pixel is valid.
  std::optional<Spread> depth;
  /// Of the valid pixels where it is finite; nothing when there is none.
  std::optional<Spread> confidence;
  /// World coordinates without the tails of each axis; empty when no pixel is valid.
  Box points;
  /// Positions of the sensors, all of them.
  Box cameras;

  /// Share of the pixels that are valid; 0 when there are no pixels.
  double coverage() const;
};

/// Loads every view once. The result does not depend on the number of threads.
/// Throws what ViewSequence::load() throws; InvalidArgument when the options are out of range; Cancelled.
ViewsSummary summarise(const ViewSequence& views, const SummaryOptions& options = {},
                       const Progress& progress = Progress());

}  // namespace vdbfuse
