// SPDX-License-Identifier: Apache-2.0
#include "surface/block_mesh.h"

#include <Eigen/Geometry>

namespace vdbfuse {
namespace {

constexpr std::uint32_t kUnused = 0xffffffff;
constexpr std::uint8_t kOwnCentre = 8;

class Builder {
 public:
  explicit Builder(const BlockNeighbourhood& leaves) : leaves_(leaves) {}

  TriangleMesh run() {
    forEachLeaf(1, kBlockLeaves, [&](const Index3& place) { addTriangles(place); });
    if (mesh_.triangles.empty()) return {};
    sums_.assign(mesh_.vertices.size(), Eigen::Vector3d::Zero());
    // Neighbours have triangles at the block's vertices, too. Always in the order of their places, so that
    // the sums do not depend on the block.
    forEachLeaf(0, kBlockLeaves + 1, [&](const Index3& place) { addNormals(place); });
    mesh_.normals.reserve(sums_.size());
    for (const Eigen::Vector3d& sum : sums_) mesh_.normals.push_back(sum.normalized().cast<float>());
    return std::move(mesh_);
  }

 private:
  template <class Visit>
  void forEachLeaf(int first, int last, const Visit& visit) const {
    for (int x = first; x <= last; ++x)
      for (int y = first; y <= last; ++y)
        for (int z = first; z <= last; ++z)
          if (leaves_[placeAround(x, y, z)] != nullptr) visit(Index3(x, y, z));
  }

  static std::size_t ownerOf(const Index3& place, const VertexRef& vertex) {
    if (vertex.corner == kOwnCentre) return placeAround(place.x(), place.y(), place.z());
    return placeAround(place.x() + (vertex.corner & 1), place.y() + (vertex.corner >> 1 & 1),
                       place.z() + (vertex.corner >> 2));
  }

  const Eigen::Vector3f& position(const Index3& place, const VertexRef& vertex) const {
    const LeafMesh& owner = *leaves_[ownerOf(place, vertex)];
    return vertex.corner == kOwnCentre ? owner.centres[vertex.rank] : owner.vertices[vertex.rank];
  }

  // The number of a vertex in the block, or kUnused.
  std::uint32_t& numberOf(const Index3& place, const VertexRef& vertex) {
    const std::size_t owner = ownerOf(place, vertex);
    const LeafMesh& leaf = *leaves_[owner];
    std::vector<std::uint32_t>& numbers = numbers_[owner];
    if (numbers.empty()) numbers.assign(leaf.vertices.size() + leaf.centres.size(), kUnused);
    return numbers[vertex.rank + (vertex.corner == kOwnCentre ? leaf.vertices.size() : 0)];
  }

  void addTriangles(const Index3& place) {
    for (const auto& t : leaves_[placeAround(place.x(), place.y(), place.z())]->triangles) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& number = numberOf(place, t[k]);
        if (number == kUnused) {
          number = static_cast<std::uint32_t>(mesh_.vertices.size());
          mesh_.vertices.push_back(position(place, t[k]));
        }
        triangle[k] = number;
      }
      mesh_.triangles.push_back(triangle);
    }
  }

  void addNormals(const Index3& place) {
    for (const auto& t : leaves_[placeAround(place.x(), place.y(), place.z())]->triangles) {
      std::array<std::uint32_t, 3> numbers;
      for (std::size_t k = 0; k < 3; ++k) numbers[k] = numberOf(place, t[k]);
      if (numbers[0] == kUnused && numbers[1] == kUnused && numbers[2] == kUnused) continue;
      const Eigen::Vector3d a = position(place, t[0]).cast<double>(),
                            b = position(place, t[1]).cast<double>(),
                            c = position(place, t[2]).cast<double>();
      const Eigen::Vector3d area = (b - a).cross(c - a);
      for (const std::uint32_t number : numbers)
        if (number != kUnused) sums_[number] += area;
    }
  }

  const BlockNeighbourhood& leaves_;
  std::array<std::vector<std::uint32_t>, std::tuple_size_v<BlockNeighbourhood>> numbers_;
  std::vector<Eigen::Vector3d> sums_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh blockMesh(const BlockNeighbourhood& leaves) { return Builder(leaves).run(); }

}  // namespace vdbfuse
