// SPDX-License-Identifier: Apache-2.0
// A sequence of views whose images are loaded when they are asked for.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Knows every view's projection and pose; loads its images on demand and keeps none.
class ViewSequence {
 public:
  /// Loads the images of view `index`. Called from several threads at once. Throws IoError.
  using Loader = std::function<DepthMap(std::size_t index)>;

  ViewSequence() = default;
  ViewSequence(std::vector<ViewHeader> headers, Loader loader);
  /// Views that are in memory already. Each load() copies one.
  static ViewSequence fromViews(std::vector<View> views);

  std::size_t size() const { return headers_.size(); }
  bool empty() const { return headers_.empty(); }
  const ViewHeader& header(std::size_t index) const { return headers_[index]; }
  /// Throws IoError when the file cannot be read, InvalidArgument (naming the view) when validate(view)
  /// objects.
  View load(std::size_t index) const;
  /// The first `count` views, or all of them when there are fewer.
  ViewSequence first(std::size_t count) const;

 private:
  std::vector<ViewHeader> headers_;
  Loader loader_;
};

}  // namespace vdbfuse
