// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "vdbfuse/sensor/noise_model.h"

namespace vdbfuse {

/// NoiseLaw in single precision, for kernels: s = constant + linear·z + quadratic·z², z not below `vertex`.
struct NoiseCurve {
  NoiseCurve() = default;
  explicit NoiseCurve(const NoiseLaw& law)
      : constant(static_cast<float>(law.constant)),
        linear(static_cast<float>(law.linear)),
        quadratic(static_cast<float>(law.quadratic)) {
    if (law.quadratic > 0) vertex = static_cast<float>(std::max(0.0, -law.linear / (2 * law.quadratic)));
  }

  float constant = 0, linear = 0, quadratic = 0;
  float vertex = 0;  ///< the noise does not change at smaller depths
};

}  // namespace vdbfuse
