// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/base/random.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse::synth {

/// Turns a view whose depth is exact (`view.true_depth`, `view.object` given) into a measured one: fills
/// `view.view.map` and `view.mistake`.
void measure(SyntheticView& view, const SynthOptions& options, Random random);

}  // namespace vdbfuse::synth
