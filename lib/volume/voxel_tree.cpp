// SPDX-License-Identifier: Apache-2.0
#include "volume/voxel_tree.h"

#include <openvdb/tree/Tree.h>
#include <openvdb/tree/ValueAccessor.h>

#include <vector>

namespace vdbfuse {
namespace {

template <class T, int Channels>
struct VoxelOf;
template <class T>
struct VoxelOf<T, 2> {
  using Type = openvdb::math::Vec2<T>;
};
template <class T>
struct VoxelOf<T, 4> {
  using Type = openvdb::math::Vec4<T>;
};

// Smaller inner nodes than OpenVDB's usual ones (8³ and 16³ children in place of 16³ and 32³): surfaces fill
// few of their children, and the pointers would take a tenth of the memory.
template <class Voxel>
using CompactTree = openvdb::tree::Tree<openvdb::tree::RootNode<
    openvdb::tree::InternalNode<openvdb::tree::InternalNode<openvdb::tree::LeafNode<Voxel, 3>, 3>, 4>>>;

openvdb::Coord toCoord(const Index3& i) { return {i.x(), i.y(), i.z()}; }

}  // namespace

template <class T, int Channels>
struct VoxelTree<T, Channels>::Impl {
  using Voxel = typename VoxelOf<T, Channels>::Type;
  using Tree = CompactTree<Voxel>;
  static_assert(sizeof(Voxel) == Channels * sizeof(T));

  Tree tree{Voxel(T(0))};
  std::vector<typename Tree::LeafNodeType*> leaves;
};

template <class T, int Channels>
VoxelTree<T, Channels>::VoxelTree() : impl_(std::make_unique<Impl>()) {}
template <class T, int Channels>
VoxelTree<T, Channels>::~VoxelTree() = default;
template <class T, int Channels>
VoxelTree<T, Channels>::VoxelTree(VoxelTree&&) noexcept = default;
template <class T, int Channels>
VoxelTree<T, Channels>& VoxelTree<T, Channels>::operator=(VoxelTree&&) noexcept = default;

template <class T, int Channels>
std::size_t VoxelTree<T, Channels>::leafCount() const {
  return impl_->leaves.size();
}

template <class T, int Channels>
Index3 VoxelTree<T, Channels>::origin(std::size_t leaf) const {
  const openvdb::Coord& o = impl_->leaves[leaf]->origin();
  return {o.x(), o.y(), o.z()};
}

template <class T, int Channels>
T* VoxelTree<T, Channels>::values(std::size_t leaf) const {
  return impl_->leaves[leaf]->buffer().data()->asPointer();
}

template <class T, int Channels>
std::optional<std::uint32_t> VoxelTree<T, Channels>::find(const Index3& origin) const {
  const auto* leaf = impl_->tree.probeConstLeaf(toCoord(origin));
  if (leaf == nullptr) return std::nullopt;
  return leaf->transientData();
}

template <class T, int Channels>
void VoxelTree<T, Channels>::find(std::span<const Index3> origins,
                                  std::optional<std::uint32_t>* numbers) const {
  // Not registered with the tree, which other threads read as well.
  openvdb::tree::ValueAccessor<const typename Impl::Tree, /*IsSafe=*/false> accessor(impl_->tree);
  for (const Index3& origin : origins) {
    const auto* leaf = accessor.probeConstLeaf(toCoord(origin));
    *numbers++ = leaf == nullptr ? std::nullopt : std::optional(leaf->transientData());
  }
}

template <class T, int Channels>
std::uint32_t VoxelTree<T, Channels>::insert(const Index3& origin) {
  auto* leaf = impl_->tree.touchLeaf(toCoord(origin));
  const auto number = static_cast<std::uint32_t>(impl_->leaves.size());
  leaf->setTransientData(number);
  impl_->leaves.push_back(leaf);
  return number;
}

template <class T, int Channels>
std::size_t VoxelTree<T, Channels>::memoryBytes() const {
  return impl_->tree.memUsage() + impl_->leaves.capacity() * sizeof(impl_->leaves[0]);
}

template class VoxelTree<float, 2>;
template class VoxelTree<std::int16_t, 2>;
template class VoxelTree<std::uint16_t, 4>;

}  // namespace vdbfuse
