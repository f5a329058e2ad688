// SPDX-License-Identifier: Apache-2.0
#include "fusion/tsdf_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "fusion/band_leaves.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kLeavesPerTask = 32, kRowsPerTask = 32;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Truncations. Of four voxels each, they reach all voxels beside a surface that is seen under 73°.
constexpr float kBefore = 1.5f;
// Corners of a leaf.
constexpr std::array<std::size_t, 8> kCorners = {0, 7, 56, 63, 448, 455, 504, 511};

// Depths and weights as the kernels read them; weights as sums can hold them exactly.
std::unique_ptr<DepthPixel[]> joined(const Image<float>& depth, const Image<float>* weight) {
  constexpr std::size_t kPixelsPerTask = 1 << 15;
  auto pixels = std::make_unique_for_overwrite<DepthPixel[]>(depth.size() + 1);
  pixels[depth.size()] = {kInvalidDepth, 0.0f};
  parallelFor(depth.size(), kPixelsPerTask, [&](std::size_t begin, std::size_t end) {
    const float* d = depth.data();
    DepthPixel* to = pixels.get();
    if (weight == nullptr) {
      for (std::size_t i = begin; i < end; ++i) to[i] = {d[i], 1.0f};
      return;
    }
    const float* w = weight->data();
    for (std::size_t i = begin; i < end; ++i) {
      // At least one quantum unless nothing; truncation of a positive number plus a half rounds.
      const float quanta = std::max(1.0f, static_cast<float>(static_cast<int>(w[i] * kTsdfWeightOne + 0.5f)));
      to[i] = {d[i], w[i] > 0 ? quanta * (1 / kTsdfWeightOne) : 0.0f};
    }
  });
  return pixels;
}

// A picture as the kernels read it.
std::vector<std::uint32_t> packed(const Image<Rgb8>& color) {
  std::vector<std::uint32_t> pixels(color.size());
  std::transform(color.begin(), color.end(), pixels.begin(), [](const Rgb8& c) {
    return static_cast<std::uint32_t>(c[0]) | static_cast<std::uint32_t>(c[1]) << 8 |
           static_cast<std::uint32_t>(c[2]) << 16;
  });
  return pixels;
}

// Where a sensor sees the voxels of leaves.
class LeafCamera {
 public:
  LeafCamera(const Projection& projection, const RigidTransform& world_from_camera, const GridFrame& frame)
      : projector_(projection, world_from_camera), frame_(frame) {}

  bool mightSee(const Index3& origin) const {
    constexpr double kHalf = 0.5 * (ScalarGrid::kLeafSide - 1);
    const Eigen::Vector3d centre = frame_.toWorld(Eigen::Vector3d(origin.cast<double>().array() + kHalf));
    return projector_.mightSee(centre, std::numbers::sqrt3 * kHalf * frame_.voxel);
  }

  void sight(const Index3& origin, LeafSight& out) const {
    if (const auto rows = projector_.rowsFrom(frame_.toWorld(origin)))
      return sightLeaf(*rows, static_cast<float>(frame_.voxel), out);
    for (std::size_t i = 0; i < kTsdfLeaf; ++i) {
      const auto seen = projector_.place(frame_.toWorld(Index3(origin + leafOffset(static_cast<int>(i)))));
      out.u[i] = seen ? static_cast<float>(seen->x) : 0.0f;
      out.v[i] = seen ? static_cast<float>(seen->y) : 0.0f;
      out.depth[i] = seen ? static_cast<float>(seen->depth) : 0.0f;
    }
  }

 private:
  Projector projector_;
  GridFrame frame_;
};

// A view that passes over the leaves of a volume.
template <class Voxels>
class Pass {
 public:
  using Value = std::remove_pointer_t<decltype(std::declval<Voxels>().values(0))>;

  Pass(TsdfVolumeState& state, Voxels& voxels, const TsdfInput& input, float sign)
      : state_(state),
        voxels_(voxels),
        input_(input),
        camera_(input.view.projection, input.view.world_from_camera, state.frame),
        joined_(joined(input.depth, input.weight)),
        tiles_(input.depth) {
    pixels_ = {input.depth.data(), joined_.get(), input.depth.width(), input.depth.height(),
               depthEdge(input.view.projection, state.frame.voxel)};
    const Pinhole* pinhole = std::get_if<Pinhole>(&input.view.projection);
    is_convex_ = pinhole != nullptr && !isDistorted(*pinhole);
    const auto truncation = static_cast<float>(state.options.truncation);
    update_ = {truncation, sign, kBefore * truncation, 0.5f / kTsdfWeightOne};
    if (state.colors && input.color != nullptr && input.color->width() > 1 && input.color->height() > 1) {
      rgb_ = packed(*input.color);
      colors_ = {rgb_.data(), input.color->width(), input.color->height()};
      if (input.view.color_sensor)
        color_camera_.emplace(input.view.color_sensor->projection, input.view.color_sensor->world_from_camera,
                              state.frame);
    }
  }

  TsdfReport run() {
    const std::vector<Index3> band = bandLeaves(input_.view, input_.depth, tiles_, state_.frame,
                                                {state_.options.truncation, state_.options.domain});
    std::vector<Outcome> outcomes(band.size());
    parallelFor(band.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      std::array<std::optional<std::uint32_t>, kLeavesPerTask> leaves;
      voxels_.find(std::span(band).subspan(begin, end - begin), leaves.data());
      for (std::size_t i = begin; i < end; ++i) outcomes[i] = meet(band[i], leaves[i - begin]);
    });
    TsdfReport report;
    for (std::size_t i = 0; i < band.size(); ++i) settle(band[i], outcomes[i], report);
    return report;
  }

  // Lets known voxels far before a measurement count as outside, in all leaves that are there.
  TsdfReport carve() {
    prepareCarving();
    std::vector<std::uint32_t> seen;
    for (std::uint32_t leaf = 0; leaf < voxels_.leafCount(); ++leaf)
      if (camera_.mightSee(voxels_.origin(leaf))) seen.push_back(leaf);
    std::vector<Outcome> outcomes(seen.size());
    parallelFor(seen.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      LeafSight sight;
      for (std::size_t i = begin; i < end; ++i) {
        outcomes[i].leaf = seen[i];
        camera_.sight(voxels_.origin(seen[i]), sight);
        const float nearest = depthOf(sight).least;
        if (is_convex_ && nearest + update_.furthest_before > depthsAround(sight).most) continue;
        outcomes[i].change.before = carveLeaf(sight, pixels_, update_, voxels_.values(seen[i]));
      }
    });
    TsdfReport report;
    for (Outcome& outcome : outcomes) settle({}, outcome, report);
    state_.is_carved = true;
    return report;
  }

 private:
  // What came of a leaf. One that does not exist is worked out beside the tree first.
  struct Outcome {
    std::optional<std::uint32_t> leaf;
    LeafChange change;
    std::unique_ptr<std::array<Value, 2 * kTsdfLeaf>> voxels;
    std::unique_ptr<std::array<std::uint16_t, 4 * kTsdfLeaf>> colors;
  };

  Outcome meet(const Index3& origin, std::optional<std::uint32_t> leaf) {
    Outcome outcome;
    outcome.leaf = leaf;
    if (!outcome.leaf && update_.sign < 0) return outcome;
    LeafSight sight;
    camera_.sight(origin, sight);
    const DepthTiles::Range depths = depthsAround(sight);
    const bool reaches = mayReach(sight, depths);
    if (outcome.leaf) {
      if (reaches) outcome.change = updateLeaf(sight, pixels_, update_, voxels_.values(*outcome.leaf));
      if (colors_.rgb != nullptr && outcome.change.in_band > 0)
        color(origin, sight, state_.colorsOf(*outcome.leaf));
      return outcome;
    }
    if (!reaches) return outcome;
    thread_local std::array<Value, 2 * kTsdfLeaf> blank;
    blank.fill(0);
    outcome.change = updateLeaf(sight, pixels_, update_, blank.data());
    if (outcome.change.in_band == 0) return outcome;
    outcome.voxels = std::make_unique<std::array<Value, 2 * kTsdfLeaf>>(blank);
    if (colors_.rgb != nullptr) {
      outcome.colors = std::make_unique<std::array<std::uint16_t, 4 * kTsdfLeaf>>();
      color(origin, sight, outcome.colors->data());
    }
    return outcome;
  }

  // What is carved by: pixels that two of the four beside them agree with. Single wrong depths would carve
  // through everything.
  void prepareCarving() {
    const int width = pixels_.width, height = pixels_.height;
    carving_ = std::make_unique_for_overwrite<DepthPixel[]>(input_.depth.size() + 1);
    carving_[input_.depth.size()] = {kInvalidDepth, 0.0f};
    parallelFor(static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
      for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
        const float *here = input_.depth.row(y), *above = input_.depth.row(std::max(y - 1, 0)),
                    *below = input_.depth.row(std::min(y + 1, height - 1));
        const DepthPixel* from = joined_.get() + static_cast<std::ptrdiff_t>(y) * width;
        DepthPixel* to = carving_.get() + static_cast<std::ptrdiff_t>(y) * width;
        to[0] = to[width - 1] = {kInvalidDepth, 0.0f};
        for (int x = 1; x + 1 < width; ++x) {
          const float step = pixels_.edge.relative * here[x] + pixels_.edge.absolute;
          const auto agrees = [&](float other) { return std::abs(other - here[x]) <= step ? 1 : 0; };
          const int count = agrees(here[x - 1]) + agrees(here[x + 1]) + agrees(above[x]) + agrees(below[x]);
          to[x] = {from[x].depth, count >= 2 ? from[x].weight : 0.0f};
        }
      }
    });
    pixels_.at = carving_.get();
  }

  // The depths around a leaf, by the tiles of the pixels between its corners and one more. Where some corners
  // are not before the sensor, or the leaf may lie beside them, anything is possible.
  DepthTiles::Range depthsAround(const LeafSight& sight) const {
    float u0 = 1e9f, v0 = 1e9f, u1 = -1e9f, v1 = -1e9f;
    for (const std::size_t corner : kCorners) {
      if (!(sight.depth[corner] > 0) || !is_convex_) return {0.0f, kInfinity};
      u0 = std::min(u0, sight.u[corner]), u1 = std::max(u1, sight.u[corner]);
      v0 = std::min(v0, sight.v[corner]), v1 = std::max(v1, sight.v[corner]);
    }
    return tiles_.over(u0 - 1, v0 - 1, u1 + 1, v1 + 1);
  }

  // Between the corners of a leaf.
  static DepthTiles::Range depthOf(const LeafSight& sight) {
    DepthTiles::Range range{kInfinity, 0.0f};
    for (const std::size_t corner : kCorners) {
      range.least = std::min(range.least, sight.depth[corner]);
      range.most = std::max(range.most, sight.depth[corner]);
    }
    return range;
  }

  // False only when no voxel of a leaf lies in the band.
  bool mayReach(const LeafSight& sight, const DepthTiles::Range& depths) const {
    if (!is_convex_) return true;
    const DepthTiles::Range own = depthOf(sight);
    return own.least <= depths.most + update_.truncation && own.most >= depths.least - update_.truncation;
  }

  void color(const Index3& origin, const LeafSight& sight, std::uint16_t* colors) {
    std::array<float, kTsdfLeaf> weight;
    const float reach = std::min(update_.truncation, 3 * static_cast<float>(state_.frame.voxel));
    colorWeights(sight, pixels_, reach, weight.data());
    if (!color_camera_) {
      // A picture of the depth sensor's own, perhaps with more pixels.
      LeafSight scaled = sight;
      const float su = static_cast<float>(colors_.width) / static_cast<float>(pixels_.width),
                  sv = static_cast<float>(colors_.height) / static_cast<float>(pixels_.height);
      for (float& u : scaled.u) u = (u + 0.5f) * su - 0.5f;
      for (float& v : scaled.v) v = (v + 0.5f) * sv - 0.5f;
      return updateColors(scaled, colors_, weight.data(), update_.sign, colors);
    }
    LeafSight other;
    color_camera_->sight(origin, other);
    updateColors(other, colors_, weight.data(), update_.sign, colors);
  }

  // Keeps what came of a leaf, in the order of the band: the same for any number of threads.
  void settle(const Index3& origin, Outcome& outcome, TsdfReport& report) {
    if (outcome.change.in_band + outcome.change.before == 0) return;
    if (!outcome.leaf && !outcome.voxels) return;
    if (!outcome.leaf) {
      outcome.leaf = state_.insert(origin);
      ++report.created;
      std::copy(outcome.voxels->begin(), outcome.voxels->end(), voxels_.values(*outcome.leaf));
      if (outcome.colors)
        std::copy(outcome.colors->begin(), outcome.colors->end(), state_.colorsOf(*outcome.leaf));
    }
    state_.last_change[*outcome.leaf] = state_.changes;
    ++report.leaves;
    report.voxels += static_cast<std::size_t>(outcome.change.in_band);
    report.before += static_cast<std::size_t>(outcome.change.before);
  }

  TsdfVolumeState& state_;
  Voxels& voxels_;
  const TsdfInput& input_;
  LeafCamera camera_;
  std::optional<LeafCamera> color_camera_;
  std::unique_ptr<DepthPixel[]> carving_;
  bool is_convex_ = false;  ///< the projection of a leaf lies between those of its corners
  std::unique_ptr<DepthPixel[]> joined_;
  DepthTiles tiles_;
  std::vector<std::uint32_t> rgb_;
  DepthPixels pixels_;
  ColorPixels colors_;
  TsdfUpdate update_;
};

// Calls use(pass) with the input's pass over the volume.
template <class Use>
TsdfReport withPass(TsdfVolumeState& state, const TsdfInput& input, float sign, const Use& use) {
  ++state.changes;
  return std::visit(
      [&](auto& voxels) {
        Pass pass(state, voxels, input, sign);
        return use(pass);
      },
      state.voxels);
}

}  // namespace

TsdfReport fuseView(const TsdfInput& input, Direction direction, TsdfVolumeState& state) {
  return withPass(state, input, direction == Direction::In ? 1.0f : -1.0f,
                  [](auto& pass) { return pass.run(); });
}

TsdfReport carveView(const TsdfInput& input, TsdfVolumeState& state) {
  return withPass(state, input, 1.0f, [](auto& pass) { return pass.carve(); });
}

}  // namespace vdbfuse
