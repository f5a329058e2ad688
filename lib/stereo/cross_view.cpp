// SPDX-License-Identifier: Apache-2.0
#include "stereo/cross_view.h"

#include <algorithm>

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {
namespace {

// Where a pixel goes, the share of each of the four around it, and its inverse depth there.
struct Landing {
  int x = 0, y = 0;
  float fx = 0, fy = 0;
  float inverse_depth = 0, weight = 0;
};

template <class Use>
void forEachLanding(const SeenDepths& from, const Pinhole& camera, const RigidTransform& world_from_camera,
                    const Use& use) {
  const ImageMotion motion = imageMotion(from.camera, from.world_from_camera, camera, world_from_camera);
  const auto& a = motion.a;
  const auto& b = motion.b;
  const DepthLayer& layer = *from.layer;
  for (int y = 0; y < from.camera.height; ++y) {
    const auto fy = static_cast<float>(y);
    for (int x = 0; x < from.camera.width; ++x) {
      const float w = layer.inverse_depth(x, y);
      if (!(w > 0)) continue;
      const auto fx = static_cast<float>(x);
      const auto row = [&](std::size_t r) {
        return a[3 * r] * fx + a[3 * r + 1] * fy + a[3 * r + 2] + w * b[r];
      };
      // The third row is depth there by depth here.
      const float ratio = row(2);
      if (!(ratio > 0)) continue;
      const float u = row(0) / ratio, v = row(1) / ratio;
      if (!(u >= 0 && v >= 0 && u < static_cast<float>(camera.width - 1) &&
            v < static_cast<float>(camera.height - 1)))
        continue;
      const int column = static_cast<int>(u), line = static_cast<int>(v);
      const float weight = std::clamp(layer.score(x, y) / from.full_score, 0.0F, 1.0F);
      use(Landing{column, line, u - static_cast<float>(column), v - static_cast<float>(line), w / ratio,
                  weight});
    }
  }
}

// Calls use(x, y, share) for the four pixels.
template <class Use>
void forEachPixel(const Landing& at, const Use& use) {
  use(at.x, at.y, (1 - at.fx) * (1 - at.fy));
  use(at.x + 1, at.y, at.fx * (1 - at.fy));
  use(at.x, at.y + 1, (1 - at.fx) * at.fy);
  use(at.x + 1, at.y + 1, at.fx * at.fy);
}

}  // namespace

Testimony seenFrom(const SeenDepths& from, const Pinhole& camera, const RigidTransform& world_from_camera,
                   float tolerance) {
  const int width = camera.width, height = camera.height;
  Image<float> nearest(width, height);
  forEachLanding(from, camera, world_from_camera, [&](const Landing& at) {
    if (at.weight < 0.1F) return;
    forEachPixel(at, [&](int x, int y, float) { nearest(x, y) = std::max(nearest(x, y), at.inverse_depth); });
  });
  Testimony result{{width, height}, {width, height}, {width, height}, {width, height}};
  Image<float> shares(width, height);
  forEachLanding(from, camera, world_from_camera, [&](const Landing& at) {
    forEachPixel(at, [&](int x, int y, float share) {
      if (at.inverse_depth < nearest(x, y) - tolerance) return;
      share += 1e-3F;
      const float weight = share * at.weight;
      result.inverse_depth(x, y) += weight * at.inverse_depth;
      result.weight(x, y) += weight;
      result.off_x(x, y) += weight * (static_cast<float>(at.x - x) + at.fx);
      result.off_y(x, y) += weight * (static_cast<float>(at.y - y) + at.fy);
      shares(x, y) += share;
    });
  });
  for (std::size_t i = 0; i < shares.size(); ++i) {
    float& weight = result.weight.data()[i];
    if (!(weight > 0)) continue;
    result.inverse_depth.data()[i] /= weight;
    result.off_x.data()[i] /= weight, result.off_y.data()[i] /= weight;
    weight /= shares.data()[i];
  }
  return result;
}

}  // namespace vdbfuse::stereo
