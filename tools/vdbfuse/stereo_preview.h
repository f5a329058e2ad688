// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse::tool {

/// The photograph, its depths (near: yellow, far: dark blue, in inverse depth between the 1 % and 99 %
/// quantiles; black: none) and their confidences (0: dark blue, 1: yellow) beside each other, each no longer
/// than 1600 pixels: every second, third, ... pixel of larger ones.
Image<Rgb8> stereoPreview(const View& view);

}  // namespace vdbfuse::tool
