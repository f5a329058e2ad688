// SPDX-License-Identifier: Apache-2.0
// Photographs of a textured and lit scene.
#pragma once

#include "seen_surface.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse::synth {

/// The picture of `scene` that the view's camera takes: textured, lit by a lamp above the front, a weaker one
/// behind and light from all around that is stronger from above; Lambert's law and a highlight, no shadows.
/// Brightness is proportional to light. A pixel is the mean over its square, centred at integer (x, y).
/// Black where there is nothing to see. The texture depends on `seed`, exposure and noise on `random`.
Image<Rgb8> takePicture(const ViewHeader& view, const Scene& scene, const SeenSurface& surface,
                        const PhotographOptions& options, std::uint64_t seed, Random random);

}  // namespace vdbfuse::synth
