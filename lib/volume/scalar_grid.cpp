// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/volume/scalar_grid.h"

#include <algorithm>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "volume/scalar_grid_impl.h"

namespace vdbfuse {
namespace {

openvdb::Coord toCoord(const Index3& i) { return {i.x(), i.y(), i.z()}; }

openvdb::math::Transform::Ptr transformOf(const GridFrame& frame) {
  auto transform = openvdb::math::Transform::createLinearTransform(frame.voxel);
  transform->postTranslate({frame.offset.x(), frame.offset.y(), frame.offset.z()});
  return transform;
}

}  // namespace

void initialiseOpenVdb() {
  static const bool kDone = [] {
    openvdb::initialize();
    return true;
  }();
  (void)kDone;
}

void ScalarGrid::Impl::listLeaves() {
  leaves.clear();
  grid->tree().getNodes(leaves);
  std::sort(leaves.begin(), leaves.end(),
            [](const auto* a, const auto* b) { return a->origin() < b->origin(); });
}

ScalarGrid::ScalarGrid(std::string name, const GridFrame& frame, float background,
                       std::vector<Index3> origins)
    : impl_(std::make_unique<Impl>()) {
  if (!(frame.voxel > 0)) throw InvalidArgument("voxel", "must be positive");
  initialiseOpenVdb();
  impl_->frame = frame;
  impl_->name = std::move(name);
  impl_->grid = openvdb::FloatGrid::create(background);
  impl_->grid->setTransform(transformOf(frame));
  openvdb::FloatGrid::Accessor accessor = impl_->grid->getAccessor();
  for (const Index3& origin : origins) accessor.touchLeaf(toCoord(origin));
  impl_->listLeaves();
}

ScalarGrid::~ScalarGrid() = default;
ScalarGrid::ScalarGrid(ScalarGrid&&) noexcept = default;
ScalarGrid& ScalarGrid::operator=(ScalarGrid&&) noexcept = default;

const std::string& ScalarGrid::name() const { return impl_->name; }
const GridFrame& ScalarGrid::frame() const { return impl_->frame; }
float ScalarGrid::background() const { return impl_->grid->background(); }
std::size_t ScalarGrid::leafCount() const { return impl_->leaves.size(); }
std::size_t ScalarGrid::memoryBytes() const { return impl_->grid->memUsage(); }
std::map<std::string, std::string>& ScalarGrid::metadata() { return impl_->metadata; }
const std::map<std::string, std::string>& ScalarGrid::metadata() const { return impl_->metadata; }
void ScalarGrid::setKind(GridKind kind) { impl_->kind = kind; }

ScalarGrid::Leaf ScalarGrid::leaf(std::size_t index) const {
  auto* node = impl_->leaves[index];
  const openvdb::Coord& o = node->origin();
  return {{o.x(), o.y(), o.z()}, std::span<float, kLeafSize>(node->buffer().data(), kLeafSize)};
}

std::optional<std::size_t> ScalarGrid::findLeaf(const Index3& origin) const {
  const openvdb::Coord wanted = toCoord(origin);
  const auto found =
      std::lower_bound(impl_->leaves.begin(), impl_->leaves.end(), wanted,
                       [](const auto* leaf, const openvdb::Coord& o) { return leaf->origin() < o; });
  if (found == impl_->leaves.end() || (*found)->origin() != wanted) return std::nullopt;
  return static_cast<std::size_t>(found - impl_->leaves.begin());
}

float ScalarGrid::at(const Index3& voxel) const { return impl_->grid->tree().getValue(toCoord(voxel)); }

float ScalarGrid::interpolate(const Eigen::Vector3d& index) const {
  const Eigen::Vector3d base = index.array().floor();
  const Index3 low = base.cast<int>();
  const Eigen::Vector3d f = index - base;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Index3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= step[a] ? f[a] : 1 - f[a];
    if (weight > 0) sum += weight * at(low + step);
  }
  return static_cast<float>(sum);
}

void ScalarGrid::forEachLeaf(const std::function<void(const Leaf&)>& visit) const {
  parallelFor(leafCount(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) visit(leaf(i));
  });
}

}  // namespace vdbfuse
