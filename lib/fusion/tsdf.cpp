// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/tsdf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <variant>

#include "fusion/band_leaves.h"
#include "fusion/prepared_view.h"
#include "fusion/tsdf_kernels.h"
#include "fusion/tsdf_state.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kLeavesPerTask = 16;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Truncations. Of four voxels each, they reach all voxels beside a surface that is seen under 75°.
constexpr float kBefore = 2;

void requireFitting(const TsdfInput& input) {
  const int width = imageWidth(input.view.projection), height = imageHeight(input.view.projection);
  const auto sizes = [&](int w, int h) {
    return "view '" + input.view.name + "': " + std::to_string(w) + "x" + std::to_string(h) +
           " pixels, the projection has " + std::to_string(width) + "x" + std::to_string(height);
  };
  if (input.depth.width() != width || input.depth.height() != height)
    throw InvalidArgument("depth", sizes(input.depth.width(), input.depth.height()));
  if (width < 2 || height < 2)
    throw InvalidArgument("depth", "view '" + input.view.name + "': at least 2x2 pixels");
  if (input.weight != nullptr && !input.weight->sameSize(input.depth))
    throw InvalidArgument("weight", sizes(input.weight->width(), input.weight->height()));
}

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
        carves_(state.options.carving == Carving::On),
        joined_(joined(input.depth, input.weight)),
        tiles_(input.depth) {
    pixels_ = {input.depth.data(), joined_.get(), input.depth.width(), input.depth.height(),
               depthEdge(input.view.projection, state.frame.voxel)};
    const Pinhole* pinhole = std::get_if<Pinhole>(&input.view.projection);
    is_convex_ = pinhole != nullptr && !isDistorted(*pinhole);
    update_ = {static_cast<float>(state.options.truncation), sign,
               carves_ ? kInfinity : kBefore * static_cast<float>(state.options.truncation), carves_,
               0.5f / kTsdfWeightOne};
    if (state.colors && input.color != nullptr && !input.color->empty()) {
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
      for (std::size_t i = begin; i < end; ++i) outcomes[i] = meet(band[i]);
    });
    TsdfReport report;
    for (std::size_t i = 0; i < band.size(); ++i) settle(band[i], outcomes[i], report);
    if (carves_) carveBeside(band, report);
    return report;
  }

  // Makes the leaves that run() would make.
  std::size_t allocate() {
    std::vector<Index3> band = bandLeaves(input_.view, input_.depth, tiles_, state_.frame,
                                          {state_.options.truncation, state_.options.domain});
    std::vector<std::uint8_t> is_new(band.size());
    parallelFor(band.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        is_new[i] = !voxels_.find(band[i]) && changes(band[i]).in_band > 0;
    });
    std::size_t made = 0;
    for (std::size_t i = 0; i < band.size(); ++i) {
      if (!is_new[i]) continue;
      state_.insert(band[i]);
      ++made;
    }
    return made;
  }

 private:
  // What came of a leaf. One that does not exist is worked out beside the tree first.
  struct Outcome {
    std::optional<std::uint32_t> leaf;
    LeafChange change;
    std::unique_ptr<std::array<Value, 2 * kTsdfLeaf>> voxels;
    std::unique_ptr<std::array<std::uint16_t, 4 * kTsdfLeaf>> colors;
  };

  Outcome meet(const Index3& origin) {
    Outcome outcome;
    outcome.leaf = voxels_.find(origin);
    if (!outcome.leaf && update_.sign < 0) return outcome;
    LeafSight sight;
    camera_.sight(origin, sight);
    if (outcome.leaf) {
      outcome.change = updateLeaf(sight, pixels_, boundsOf(sight), update_, voxels_.values(*outcome.leaf));
      if (colors_.rgb != nullptr && outcome.change.in_band > 0)
        color(origin, sight, state_.colorsOf(*outcome.leaf));
      return outcome;
    }
    thread_local std::array<Value, 2 * kTsdfLeaf> blank;
    blank.fill(0);
    outcome.change = updateLeaf(sight, pixels_, boundsOf(sight), update_, blank.data());
    if (outcome.change.in_band == 0) return outcome;
    outcome.voxels = std::make_unique<std::array<Value, 2 * kTsdfLeaf>>(blank);
    if (colors_.rgb != nullptr) {
      outcome.colors = std::make_unique<std::array<std::uint16_t, 4 * kTsdfLeaf>>();
      color(origin, sight, outcome.colors->data());
    }
    return outcome;
  }

  // The depths around a leaf, by the tiles of the pixels between its corners and one more.
  DepthBounds boundsOf(const LeafSight& sight) const {
    float u0 = 1e9f, v0 = 1e9f, u1 = -1e9f, v1 = -1e9f;
    for (const std::size_t corner : {0, 7, 56, 63, 448, 455, 504, 511}) {
      // Some corners lie behind the sensor, or are not seen at all: anything is possible.
      if (!(sight.depth[corner] > 0) || !is_convex_) return {0.0f, 1e30f};
      u0 = std::min(u0, sight.u[corner]), u1 = std::max(u1, sight.u[corner]);
      v0 = std::min(v0, sight.v[corner]), v1 = std::max(v1, sight.v[corner]);
    }
    const DepthTiles::Range range = tiles_.over(u0 - 1, v0 - 1, u1 + 1, v1 + 1);
    return {range.least, range.most};
  }

  // What the view would do to a leaf that is not there.
  LeafChange changes(const Index3& origin) const {
    LeafSight sight;
    camera_.sight(origin, sight);
    std::array<Value, 2 * kTsdfLeaf> blank{};
    return updateLeaf(sight, pixels_, boundsOf(sight), update_, blank.data());
  }

  void color(const Index3& origin, const LeafSight& sight, std::uint16_t* colors) {
    std::array<float, kTsdfLeaf> weight;
    const float reach = std::min(update_.truncation, 2 * static_cast<float>(state_.frame.voxel));
    bandWeights(sight, pixels_, reach, weight.data());
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

  // Leaves before the band: those that exist and are seen past.
  void carveBeside(const std::vector<Index3>& band, TsdfReport& report) {
    std::vector<std::uint32_t> before;
    for (std::uint32_t leaf = 0; leaf < voxels_.leafCount(); ++leaf) {
      if (state_.last_change[leaf] == state_.changes) continue;
      const Index3 origin = voxels_.origin(leaf);
      if (camera_.mightSee(origin) && !std::binary_search(band.begin(), band.end(), origin, originBefore))
        before.push_back(leaf);
    }
    std::vector<Outcome> outcomes(before.size());
    parallelFor(before.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      LeafSight sight;
      for (std::size_t i = begin; i < end; ++i) {
        camera_.sight(voxels_.origin(before[i]), sight);
        outcomes[i].leaf = before[i];
        outcomes[i].change = updateLeaf(sight, pixels_, boundsOf(sight), update_, voxels_.values(before[i]));
      }
    });
    for (Outcome& outcome : outcomes) settle({}, outcome, report);
  }

  TsdfVolumeState& state_;
  Voxels& voxels_;
  const TsdfInput& input_;
  LeafCamera camera_;
  std::optional<LeafCamera> color_camera_;
  bool carves_;
  bool is_convex_ = false;  ///< the projection of a leaf lies between those of its corners
  std::unique_ptr<DepthPixel[]> joined_;
  DepthTiles tiles_;
  std::vector<std::uint32_t> rgb_;
  DepthPixels pixels_;
  ColorPixels colors_;
  TsdfUpdate update_;
};

// calls use(pass) with the input's pass over the volume.
template <class Use>
auto withPass(TsdfVolumeState& state, const TsdfInput& input, float sign, const Use& use) {
  return std::visit(
      [&](auto& voxels) {
        Pass pass(state, voxels, input, sign);
        return use(pass);
      },
      state.voxels);
}

TsdfReport passOver(TsdfVolumeState& state, const TsdfInput& input, float sign) {
  requireFitting(input);
  ++state.changes;
  return withPass(state, input, sign, [](auto& pass) { return pass.run(); });
}

}  // namespace

std::vector<std::string> validate(const TsdfOptions& options) {
  std::vector<std::string> problems;
  if (!(options.truncation > 0) || !std::isfinite(options.truncation))
    problems.emplace_back("truncation must be positive");
  if (options.domain && options.domain->isEmpty()) problems.emplace_back("domain must not be empty");
  return problems;
}

double truncationFor(double noise_scale, double outlier_share) {
  if (!(outlier_share > 0 && outlier_share < 1))
    throw InvalidArgument("outlier_share", "must lie between 0 and 1");
  return noise_scale * std::numbers::sqrt3 / std::numbers::pi * std::log((2 - outlier_share) / outlier_share);
}

TsdfVolume::TsdfVolume(const GridFrame& frame, const TsdfOptions& options) {
  if (!(frame.voxel > 0)) throw InvalidArgument("voxel", "must be positive");
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
  impl_ = std::make_unique<Impl>(Impl{TsdfVolumeState(frame, options)});
}
TsdfVolume::~TsdfVolume() = default;
TsdfVolume::TsdfVolume(TsdfVolume&&) noexcept = default;
TsdfVolume& TsdfVolume::operator=(TsdfVolume&&) noexcept = default;

TsdfReport TsdfVolume::integrate(const TsdfInput& input) { return passOver(impl_->state, input, 1.0f); }

TsdfReport TsdfVolume::remove(const TsdfInput& input) {
  if (options().carving == Carving::On)
    throw InvalidArgument("carving", "a view cannot be taken out of a volume that is carved");
  return passOver(impl_->state, input, -1.0f);
}

std::size_t TsdfVolume::allocate(const TsdfInput& input) {
  requireFitting(input);
  return withPass(impl_->state, input, 1.0f, [](auto& pass) { return pass.allocate(); });
}

const GridFrame& TsdfVolume::frame() const { return impl_->state.frame; }
const TsdfOptions& TsdfVolume::options() const { return impl_->state.options; }
std::size_t TsdfVolume::leafCount() const { return impl_->state.leafCount(); }
std::size_t TsdfVolume::memoryBytes() const { return impl_->state.memoryBytes(); }
std::size_t TsdfVolume::changes() const { return impl_->state.changes; }
std::size_t TsdfVolume::lastChange(std::size_t leaf) const { return impl_->state.last_change[leaf]; }
Index3 TsdfVolume::leafOriginOf(std::size_t leaf) const { return impl_->state.origin(leaf); }

void TsdfVolume::copyDistances(std::size_t leaf, float least_weight,
                               std::span<float, ScalarGrid::kLeafSize> out) const {
  impl_->state.decode(leaf, [&](std::size_t i, float distance, float weight) {
    out[i] = weight > least_weight ? distance : kUnknown;
  });
}

namespace {

// The leaves that hold something, as a grid; value(distance, weight) at each voxel.
template <class Value>
ScalarGrid gridOf(const TsdfVolumeState& state, const char* name, float background, const Value& value) {
  std::vector<std::uint8_t> is_used(state.leafCount());
  parallelFor(state.leafCount(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf)
      state.decode(leaf, [&](std::size_t, float, float weight) { is_used[leaf] |= weight > 0; });
  });
  std::vector<Index3> origins;
  for (std::size_t leaf = 0; leaf < state.leafCount(); ++leaf)
    if (is_used[leaf]) origins.push_back(state.origin(leaf));
  ScalarGrid grid(name, state.frame, background, origins);
  grid.forEachLeaf([&](const ScalarGrid::Leaf& target) {
    state.decode(*state.find(target.origin), [&](std::size_t i, float distance, float weight) {
      target.values[i] = value(distance, weight);
    });
  });
  return grid;
}

}  // namespace

ScalarGrid TsdfVolume::distance(float least_weight) const {
  ScalarGrid grid = gridOf(impl_->state, "surface", kUnknown, [&](float distance, float weight) {
    return weight > least_weight ? distance : kUnknown;
  });
  grid.setKind(GridKind::LevelSet);
  grid.metadata()["about"] = "truncated signed distance (Curless and Levoy 1996), > 0 outside";
  return grid;
}

ScalarGrid TsdfVolume::weight() const {
  return gridOf(impl_->state, "weight", 0.0f, [](float, float weight) { return weight; });
}

std::vector<double> untruncatedSum(const JudgedViews& judged, const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> sums(points.size(), 0.0);
  for (const JudgedView& view : judged.views) {
    const PreparedView prepared(view, judged.sensor);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::optional<Sighting> seen = prepared.projector(points[i]);
      if (!seen) continue;
      const float measured = prepared.view->depth(seen->x, seen->y);
      if (measured == kInvalidDepth) continue;
      sums[i] += prepared.view->weight * (measured - seen->depth) / prepared.noise.at(measured);
    }
    letGo(view);
  }
  return sums;
}

}  // namespace vdbfuse
