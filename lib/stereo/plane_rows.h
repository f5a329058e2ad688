// SPDX-License-Identifier: Apache-2.0
// What the kernel of planeFitted() works on.
#pragma once

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {

struct PlaneRows {
  const float* value;
  const float* weight;
  int stride;
  int radius;
  float first_scale, scale;
  int rounds;
};

}  // namespace vdbfuse::stereo
