// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// Blue at −1, white at 0, red at +1; values beyond are clamped.
Rgb8 divergingColor(double value);

/// Dark blue at 0 over green to yellow at 1, lightness growing throughout; values beyond are clamped.
Rgb8 sequentialColor(double value);

}  // namespace vdbfuse
