// SPDX-License-Identifier: Apache-2.0
// The inner loops of the evidence, for the best instruction set of the machine.
#pragma once

#include <initializer_list>

#include "fusion/likelihood_ratio.h"
#include "fusion/packed_normal.h"
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

/// The same for images of four bytes a pixel, where points that follow each other mostly lie side by side.
void prefetchLines(std::initializer_list<const void*> images, const BlockLook& look, std::size_t size);

/// look(), and what testify() will read is on its way.
BlockLook look(const PreparedView& view, const PointBlock& block);

/// Compares the depths of points with what was measured there: the same within `sigmas` combined standard
/// deviations of the measurement and of the points' own `noise`, which has PointBlock::kCapacity numbers.
BlockComparison compare(const float* measurements, const LookupVariance& variance, float sigmas,
                        const float* noise, const BlockLook& look, std::size_t size);

/// Normals of the points of a block.
using BlockNormals = std::array<PackedNormal, PointBlock::kCapacity>;

/// Turns `Same` into `Nearer` where the surface that was measured is turned away by more than 45° from the
/// points' own: it is another, which hides them. An unknown normal is not. `measured`: an image.
void tellSidesApart(const BlockNormals& normals, const PackedNormal* measured, const BlockLook& look,
                    std::size_t size, BlockComparison& comparison);

/// How many views gave an answer; `hidden`: something nearer although the surface faces them.
struct BlockAnswers {
  alignas(64) std::array<std::int32_t, PointBlock::kCapacity> agreeing{}, past{}, missed{}, hidden{};
};

/// Counts a view's answers. It sees a surface at less than 75° that it faces; one with an unknown normal may
/// face anything. `sensor`: where the view was taken from.
void count(const BlockComparison& comparison, const BlockNormals& normals, const Eigen::Vector3d& sensor,
           const PointBlock& block, BlockAnswers& answers);

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
