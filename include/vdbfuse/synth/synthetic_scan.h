// SPDX-License-Identifier: Apache-2.0
// A scanner that knows the truth: depth maps of a scene with mistakes of known kind, size and place.
#pragma once

#include <memory>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/sensor/photograph.h"
#include "vdbfuse/sensor/view_sequence.h"
#include "vdbfuse/synth/scene.h"
#include "vdbfuse/synth/synth_options.h"

namespace vdbfuse {

/// What is wrong with a pixel: the values of SyntheticView::mistake.
enum class Mistake : std::uint8_t {
  None = 0,
  Mixed = 1,    ///< silhouette pixel blended with what lies behind it
  Patch = 2,    ///< part of a patch at a wrong depth
  Outlier = 3,  ///< a random depth
};

/// A view and the truth about it; with its picture where the options ask for photographs. All images have the
/// size of the view.
struct SyntheticView {
  View view;
  Image<float> true_depth;     ///< kInvalidDepth where there is nothing to see
  Image<std::uint8_t> object;  ///< 1 where the pixel sees the scene's truth, 0 for background
  /// A Mistake a pixel. A pixel counts as wrong when a mistake was made and moved it by more than three
  /// standard deviations of the noise (any distance where there is nothing to see); a missing pixel is not
  /// wrong.
  Image<std::uint8_t> mistake;
};

/// Counts over a number of views.
struct ScanStatistics {
  std::size_t pixels = 0;
  std::size_t object_pixels = 0;        ///< that see the object
  std::size_t object_measured = 0;      ///< of these, with a depth
  std::size_t object_wrong = 0;         ///< of these, a wrong one
  std::size_t background_measured = 0;  ///< background pixels with a depth
  std::size_t background_wrong = 0;     ///< of these, a wrong one
};
ScanStatistics& operator+=(ScanStatistics& sum, const ScanStatistics& other);
ScanStatistics statistics(const SyntheticView& view);

/// Whether photographs come with the outline of the object.
enum class Silhouettes { None, True };

/// Renders views on demand. A view comes out the same whenever, on whatever thread and in whatever order it
/// is asked for: its random numbers depend on the seed and its index only. Cheap to copy.
class SyntheticScan {
 public:
  /// With Arc::Room the scene is put into a room first. Throws InvalidArgument listing all of
  /// validate(options).
  SyntheticScan(Scene scene, const SynthOptions& options);

  std::size_t size() const;
  const Scene& scene() const;
  const SynthOptions& options() const;
  const ViewHeader& header(std::size_t index) const;
  /// REQUIRES: index < size(). Uses several threads when there are any to spare.
  SyntheticView render(std::size_t index) const;
  /// The views without the truth, rendered whenever they are loaded. Outlives this object.
  ViewSequence views() const;
  /// The view's camera, with depthRange() for its depths.
  PhotographHeader photographHeader(std::size_t index) const;
  /// The pictures of the views alone, rendered whenever they are loaded.
  /// Outlives this object. Throws InvalidArgument when the options ask for none.
  PhotographSequence photographs(Silhouettes silhouettes = Silhouettes::None) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// All views of a scan at once, in order.
std::vector<SyntheticView> renderAll(const SyntheticScan& scan, const Progress& progress = {});

}  // namespace vdbfuse
