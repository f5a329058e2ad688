// SPDX-License-Identifier: Apache-2.0
// One photograph and its partners at one level of their pyramids: what a sweep works on.
#pragma once

#include <memory>
#include <vector>

#include "stereo/matching_constants.h"
#include "stereo/reference_level.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse::stereo {

struct PosedPyramid {
  std::shared_ptr<const std::vector<PictureLevel>> levels;
  RigidTransform world_from_camera = RigidTransform::Identity();
};

struct MatchInput {
  PosedPyramid reference;
  std::vector<PosedPyramid> partners;  ///< with as many levels as the reference at least
  DepthInterval depths;
};

/// Step of a sweep, in pixels of its level in the widest partner: as fine as mode `paper`.
inline constexpr auto kExactStep = static_cast<float>(kPaperStep);

struct Stage {
  ReferenceLevel reference;
  std::vector<const PictureLevel*> pictures;
  std::vector<ImageMotion> motions;
  float pixel = 0;            ///< inverseDepthOfPixel()
  float first = 0, last = 0;  ///< range of inverse depths
  SweepLimits limits;
};

/// `threshold`: least score of a peak. Pixels whose rays miss StereoOptions::domain have no window.
Stage stageOf(const MatchInput& input, int level, const StereoOptions& options, double threshold);

/// Inverse depth by which the picture moves by one pixel of level `level` in the widest partner, in the
/// middle of the picture and of its depths.
float inverseDepthOfPixel(const MatchInput& input, int level);

/// Calls body(rectangle) for every tile with a window, on several threads.
template <class Body>
void forEachTile(const ReferenceLevel& reference, const Body& body) {
  const std::vector<TileRect> tiles = tilesOf(reference);
  parallelFor(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(tiles[i]);
  });
}

/// Calls use(pixel of the tile, x, y) for every window of it.
template <class Use>
void forEachWindow(const SweepTile& tile, const Use& use) {
  for (int y = 0; y < tile.height; ++y) {
    for (int x = 0; x < tile.width; ++x) {
      const std::size_t pixel = tile.at(x, y);
      if (tile.inverse_spread[pixel] > 0) use(pixel, tile.x0 + x, tile.y0 + y);
    }
  }
}

}  // namespace vdbfuse::stereo
