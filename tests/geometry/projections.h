// SPDX-License-Identifier: Apache-2.0
// One sensor of every kind, none of them symmetric.
#pragma once

#include <vector>

#include "vdbfuse/geometry/projection.h"

namespace vdbfuse::test {

inline Pinhole distortedPinhole() { return {64, 48, 60, 55, 30.5, 25, {-0.12, 0.05, 0.002, -0.001, -0.01}}; }

inline std::vector<Projection> oneOfEach() {
  return {Pinhole{64, 48, 60, 55, 30.5, 25, {}},         distortedPinhole(),
          Spherical{360, 90, -3.1, 0.0174, -0.8, 0.015}, Spherical{90, 60, 2.0, -0.02, 0.5, -0.015},
          Orthographic{64, 48, -1.0, 0.03, 0.7, -0.02},  PushBroom{64, 48, -1.0, 0.03, 0.2, 55, 25}};
}

}  // namespace vdbfuse::test
