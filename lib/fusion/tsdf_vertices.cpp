// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "fusion/tsdf_state.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kVerticesPerTask = 4096;

// Looks voxels up one after the other, mostly in the same leaf.
class VoxelReader {
 public:
  explicit VoxelReader(const TsdfVolumeState& state) : state_(state) {}

  float weight(const Index3& voxel) {
    const auto leaf = find(voxel);
    if (!leaf) return 0.0f;
    const std::size_t i = 2 * leafPlace(voxel) + 1;
    if (const auto* single = std::get_if<TsdfVolumeState::SingleTree>(&state_.voxels))
      return single->values(*leaf)[i];
    const auto& half = std::get<TsdfVolumeState::HalfTree>(state_.voxels);
    return static_cast<float>(half.values(*leaf)[i]) / kHalfWeight;
  }
  /// (r, g, b) · weight and weight.
  Eigen::Array4f color(const Index3& voxel) {
    const auto leaf = find(voxel);
    if (!leaf) return Eigen::Array4f::Zero();
    const std::uint16_t* v = state_.colorsOf(*leaf) + 4 * leafPlace(voxel);
    const float weight = static_cast<float>(v[3]) / kColorWeight, scale = weight / kColorOne;
    return {static_cast<float>(v[0]) * scale, static_cast<float>(v[1]) * scale,
            static_cast<float>(v[2]) * scale, weight};
  }

 private:
  std::optional<std::uint32_t> find(const Index3& voxel) {
    const Index3 origin = leafOrigin(voxel);
    if (!has_last_ || origin != last_origin_)
      last_ = state_.find(origin), last_origin_ = origin, has_last_ = true;
    return last_;
  }

  const TsdfVolumeState& state_;
  bool has_last_ = false;
  Index3 last_origin_ = Index3::Zero();
  std::optional<std::uint32_t> last_;
};

// visit(voxel, share) for the voxels that a place in the grid lies between.
template <class Visit>
void forEachCorner(const Eigen::Vector3d& index, const Visit& visit) {
  const Eigen::Vector3d base = index.array().floor(), f = index - base;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 step(corner >> 2, corner >> 1 & 1, corner & 1);
    double share = 1;
    for (int a = 0; a < 3; ++a) share *= step[a] ? f[a] : 1 - f[a];
    // Vertices lie on edges of the grid, to the precision of their coordinates.
    if (share > 1e-3) visit(Index3(base.cast<int>() + step), static_cast<float>(share));
  }
}

Rgb8 rounded(const Eigen::Array4f& sum) {
  Rgb8 color{};
  if (sum[3] <= 0) return color;
  for (int c = 0; c < 3; ++c)
    color[static_cast<std::size_t>(c)] =
        static_cast<std::uint8_t>(std::clamp(sum[c] / sum[3] + 0.5f, 0.0f, 255.0f));
  return color;
}

}  // namespace

void TsdfVolume::describeVertices(TriangleMesh& mesh) const {
  mesh.support.resize(mesh.vertices.size());
  if (impl_->state.colors) mesh.colors.resize(mesh.vertices.size());
  describeVertices(mesh, 0, mesh.vertices.size());
}

void TsdfVolume::describeVertices(TriangleMesh& mesh, std::size_t first, std::size_t last) const {
  const TsdfVolumeState& state = impl_->state;
  parallelFor(last - first, kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    VoxelReader voxels(state);
    for (std::size_t v = first + begin; v < first + end; ++v) {
      const Eigen::Vector3d index = state.frame.toIndex(mesh.vertices[v].cast<double>());
      float weight = 0;
      Eigen::Array4f color = Eigen::Array4f::Zero();
      forEachCorner(index, [&](const Index3& voxel, float share) {
        weight += share * voxels.weight(voxel);
        if (state.colors) color += share * voxels.color(voxel);
      });
      mesh.support[v] = weight;
      if (state.colors) mesh.colors[v] = rounded(color);
    }
  });
}

}  // namespace vdbfuse
