// SPDX-License-Identifier: Apache-2.0
// What vdbfuse.DataSet holds.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "python/binding.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/sensor/noise_model.h"

namespace vdbfuse::python {

struct DataSet {
  DepthSet set;  ///< its views may come without pictures
  /// The same views with their pictures.
  std::function<ViewSequence()> pictures;
  // Of depth maps made from photographs: what is known of their noise, and the window of each depth.
  std::optional<NoiseLaw> noise = std::nullopt;
  int window_px = 0;
  /// What is known of the views' making; None: nothing.
  Held report = nullptr;
};

using DataSetPointer = std::shared_ptr<DataSet>;

/// Views that hold their pictures, if any.
DataSetPointer makeDataSet(ViewSequence views, const char* format);

}  // namespace vdbfuse::python
