// SPDX-License-Identifier: Apache-2.0
// Pyramids of photographs, made when they are asked for and forgotten when there are too many.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <unordered_map>
#include <vector>

#include "stereo/picture_pyramid.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse::stereo {

using Pyramid = std::vector<PictureLevel>;

/// All have the levels that matchView() needs for the largest photograph, which may meet any other. Not for
/// several threads.
class PyramidStore {
 public:
  PyramidStore(const PhotographSequence& photographs, const StereoOptions& options);
  /// Throws what loading the photograph throws.
  std::shared_ptr<const Pyramid> get(std::size_t index);

 private:
  const PhotographSequence& photographs_;
  int levels_ = 1;
  std::size_t bytes_ = 0;
  std::list<std::size_t> recent_;  // last used first
  std::unordered_map<std::size_t, std::shared_ptr<const Pyramid>> kept_;
};

}  // namespace vdbfuse::stereo
