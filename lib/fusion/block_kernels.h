// SPDX-License-Identifier: Apache-2.0
// The inner loops of the evidence, for the best instruction set of the machine.
#pragma once

#include "fusion/likelihood_ratio.h"
#include "fusion/point_block.h"
#include "fusion/prepared_view.h"
#include "fusion/visibility_integral.h"

namespace vdbfuse {

/// Projects the points of a block. Pinholes without distortion: single precision, many points at a time; a
/// point within 1e-4 pixels of the border between two pixels may be given to either.
BlockLook look(const Projector& projector, const PointBlock& block);

/// Starts loading the pixels of an image that were looked up: waiting for them is most of a kernel's time
/// otherwise.
void prefetch(const float* image, const BlockLook& look, std::size_t size);

/// look(), and what testify() will read is on its way.
BlockLook look(const PreparedView& view, const PointBlock& block);

/// Compares the depths of points with what was measured there: the same within `sigmas` combined standard
/// deviations of the measurement and of the points' own `noise`, which has PointBlock::kCapacity numbers.
BlockComparison compare(const float* measurements, const NoiseTable& measurements_noise, float sigmas,
                        const float* noise, const BlockLook& look, std::size_t size);

/// log L of every point whose pixel is measured: LikelihoodRatio of all its hypotheses. `thickness`: τ of
/// BlockTestimony::share, 0: infinite.
BlockTestimony testify(const PreparedView& view, const LikelihoodRatio& ratio, float thickness,
                       const BlockLook& look, std::size_t size);

/// The kernel of C(x) is cut off at this many widths.
inline constexpr float kAgreementReach = 2.0f;

/// counts[i] += weight (1 − ε) exp(−(r/max(voxel, s))²), r the distance between depth and measurement: one
/// view's part of C (agreement.h). `counts`: at the start of a vector of PointBlock::kCapacity.
void agree(const PreparedView& view, float voxel, float weight, const BlockLook& look, std::size_t size,
           float* counts);

/// sums[i · nodes + k] += weight · share_i · log(1 − v_k + v_k L_i).
void accumulate(const VisibilityIntegral& integral, const BlockTestimony& testimony, float weight,
                std::size_t size, float* sums);

/// out[i] = log of the mean over the nodes of e^sums: VisibilityIntegral::logMean() of each point, at
/// most PointBlock::kCapacity of them.
void logMeans(const VisibilityIntegral& integral, const float* sums, std::size_t size, float* out);

/// Name of the instruction set in use.
const char* simdTarget();

}  // namespace vdbfuse
