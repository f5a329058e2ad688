// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/tsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fusion/prepared_view.h"
#include "fusion/tsdf_pass.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kLeavesPerTask = 32;

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

TsdfReport TsdfVolume::integrate(const TsdfInput& input) {
  requireFitting(input);
  return fuseView(input, Direction::In, impl_->state);
}

TsdfReport TsdfVolume::remove(const TsdfInput& input) {
  if (impl_->state.is_carved)
    throw InvalidArgument("input", "a view cannot be taken out of a volume that was carved");
  requireFitting(input);
  return fuseView(input, Direction::Out, impl_->state);
}

TsdfReport TsdfVolume::carve(const TsdfInput& input) {
  requireFitting(input);
  return carveView(input, impl_->state);
}

void TsdfVolume::growDomain(const Box& domain) {
  if (impl_->state.options.domain) impl_->state.options.domain->extend(domain);
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
