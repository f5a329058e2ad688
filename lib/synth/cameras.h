// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "vdbfuse/sensor/view.h"
#include "vdbfuse/synth/scene.h"
#include "vdbfuse/synth/synth_options.h"

namespace vdbfuse::synth {

/// The views of `options.arc` around `scene`, named 00000000, 00000001 …
std::vector<ViewHeader> placeCameras(const Scene& scene, const SynthOptions& options);

}  // namespace vdbfuse::synth
