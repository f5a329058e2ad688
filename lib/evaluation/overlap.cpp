// SPDX-License-Identifier: Apache-2.0
#include "overlap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

// Cells along the side of the blocks that are one unit of parallel work, and of those that are not divided
// further.
constexpr int kLargeBlock = 16, kSmallBlock = 2;

// Cells by what they are; `lost` and `invented` only where the mesh is wrong deeper than asked for.
struct Counts {
  std::size_t both = 0, any = 0, truth = 0, lost = 0, invented = 0;
  Counts& operator+=(const Counts& other) {
    both += other.both;
    any += other.any;
    truth += other.truth;
    lost += other.lost;
    invented += other.invented;
    return *this;
  }
};

enum class Place { Unknown, Inside, Outside };
enum class Depth { Unknown, Shallow, Deep };

struct Grid {
  Box box;
  Eigen::Vector3i count;
  Vector3d cell;

  // Cells are nearly cubic, `resolution` of them along the longest side.
  Grid(const Box& whole, int resolution) : box(whole) {
    const Vector3d sides = box.sizes();
    for (int k = 0; k < 3; ++k) {
      const double wanted = std::ceil(resolution * sides[k] / sides.maxCoeff() - 1e-9);
      count[k] = std::max(1, static_cast<int>(wanted));
      cell[k] = sides[k] / count[k];
    }
  }
  Vector3d corner(const Eigen::Vector3i& index) const {
    return box.min() + cell.cwiseProduct(index.cast<double>());
  }
  Vector3d randomPoint(const Eigen::Vector3i& index, std::uint64_t seed) const {
    const auto at = [&](int k) { return static_cast<std::uint64_t>(index[k]); };
    const auto size = [&](int k) { return static_cast<std::uint64_t>(count[k]); };
    Random random(seed, at(0) + size(0) * (at(1) + size(1) * at(2)));
    const double u = random.uniform(), v = random.uniform(), w = random.uniform();
    return corner(index) + cell.cwiseProduct(Vector3d(u, v, w));
  }
};

// Cells low … high − 1.
struct Block {
  Eigen::Vector3i low, high;
  std::size_t cells() const {
    const Eigen::Matrix<std::size_t, 3, 1> sides = (high - low).cast<std::size_t>();
    return sides.prod();
  }
};

class OverlapCounter {
 public:
  /// Nothing is counted in `excluded`.
  OverlapCounter(const Solid& mesh, const Solid& truth, const Grid& grid, const Box& excluded,
                 const OverlapOptions& options)
      : mesh_(mesh),
        truth_(truth),
        grid_(grid),
        excluded_(excluded),
        seed_(options.seed),
        deep_(options.deep) {}

  Counts count() const {
    std::vector<Block> blocks;
    for (int z = 0; z < grid_.count.z(); z += kLargeBlock) {
      for (int y = 0; y < grid_.count.y(); y += kLargeBlock) {
        for (int x = 0; x < grid_.count.x(); x += kLargeBlock) {
          const Eigen::Vector3i low(x, y, z), end = low.array() + kLargeBlock;
          blocks.push_back({low, end.cwiseMin(grid_.count)});
        }
      }
    }
    std::vector<Counts> parts(blocks.size());
    parallelFor(blocks.size(), 1, [&](std::size_t i, std::size_t) {
      visit(blocks[i], Place::Unknown, Place::Unknown, parts[i]);
    });
    Counts total;
    for (const Counts& part : parts) total += part;
    return total;
  }

 private:
  void visit(const Block& block, Place in_mesh, Place in_truth, Counts& counts) const {
    const Box box(grid_.corner(block.low), grid_.corner(block.high));
    if (excluded_.contains(box)) return;
    in_mesh = decide(mesh_, in_mesh, box);
    in_truth = decide(truth_, in_truth, box);
    const bool decided = in_mesh != Place::Unknown && in_truth != Place::Unknown;
    const Depth depth = decided ? depthOf(box, in_mesh, in_truth) : Depth::Unknown;
    if (depth != Depth::Unknown && !excluded_.intersects(box)) {
      add({in_mesh, in_truth, depth}, block.cells(), counts);
    } else if ((block.high - block.low).maxCoeff() > kSmallBlock) {
      visitParts(block, in_mesh, in_truth, counts);
    } else {
      visitCells(block, in_mesh, in_truth, counts);
    }
  }

  // A ball without surface has one winding number where the mesh is closed. Where it is open, the winding
  // number is harmonic in the ball; by Harnack's inequality it grows at most threefold up to a third of the
  // radius, so that what is below 0.15 in the middle stays below one half, and the same from above.
  static Place decide(const Solid& solid, Place known, const Box& box) {
    if (known != Place::Unknown) return known;
    if (!solid.box.intersects(box)) return Place::Outside;
    const double radius = 0.5 * box.diagonal().norm(), reach = solid.closed ? radius : 3 * radius;
    if (solid.surface.query(box.center()).distance <= reach) return Place::Unknown;
    const double winding = solid.winding.at(box.center()), margin = solid.closed ? 0.5 : 0.15;
    if (winding < margin) return Place::Outside;
    return winding > 1 - margin ? Place::Inside : Place::Unknown;
  }

  // The distance to the surface changes by no more than the way to the centre.
  Depth depthOf(const Box& box, Place in_mesh, Place in_truth) const {
    if (!deep_ || in_mesh == in_truth) return Depth::Shallow;
    const double radius = 0.5 * box.diagonal().norm();
    const double distance = truth_.surface.query(box.center()).distance;
    if (distance - radius > *deep_) return Depth::Deep;
    return distance + radius <= *deep_ ? Depth::Shallow : Depth::Unknown;
  }

  struct Kind {
    Place in_mesh, in_truth;
    Depth depth;
  };

  static void add(const Kind& kind, std::size_t cells, Counts& counts) {
    const bool mesh = kind.in_mesh == Place::Inside, truth = kind.in_truth == Place::Inside;
    if (mesh && truth) counts.both += cells;
    if (mesh || truth) counts.any += cells;
    if (truth) counts.truth += cells;
    if (kind.depth != Depth::Deep) return;
    if (truth && !mesh) counts.lost += cells;
    if (mesh && !truth) counts.invented += cells;
  }

  void visitParts(const Block& block, Place in_mesh, Place in_truth, Counts& counts) const {
    const Eigen::Vector3i middle = (block.low + block.high) / 2;
    for (int part = 0; part < 8; ++part) {
      Block child = block;
      for (int k = 0; k < 3; ++k) (part >> k & 1 ? child.low : child.high)[k] = middle[k];
      if (child.cells() > 0) visit(child, in_mesh, in_truth, counts);
    }
  }

  static Place placeOf(const Solid& solid, Place known, const Vector3d& p) {
    if (known != Place::Unknown) return known;
    return solid.box.contains(p) && solid.winding.inside(p) ? Place::Inside : Place::Outside;
  }

  Kind kindOf(const Vector3d& p, Place in_mesh, Place in_truth) const {
    in_mesh = placeOf(mesh_, in_mesh, p);
    in_truth = placeOf(truth_, in_truth, p);
    const bool deep = deep_ && in_mesh != in_truth && truth_.surface.query(p).distance > *deep_;
    return {in_mesh, in_truth, deep ? Depth::Deep : Depth::Shallow};
  }

  void visitCells(const Block& block, Place in_mesh, Place in_truth, Counts& counts) const {
    for (int z = block.low.z(); z < block.high.z(); ++z) {
      for (int y = block.low.y(); y < block.high.y(); ++y) {
        for (int x = block.low.x(); x < block.high.x(); ++x) {
          const Vector3d p = grid_.randomPoint({x, y, z}, seed_);
          if (!excluded_.contains(p)) add(kindOf(p, in_mesh, in_truth), 1, counts);
        }
      }
    }
  }

  const Solid& mesh_;
  const Solid& truth_;
  const Grid& grid_;
  const Box& excluded_;
  std::uint64_t seed_;
  std::optional<double> deep_;
};

}  // namespace

Box finiteBox(const TriangleMesh& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) {
    const bool finite = std::all_of(t.begin(), t.end(), [&](auto v) { return mesh.vertices[v].allFinite(); });
    for (std::size_t k = 0; finite && k < 3; ++k) box.extend(mesh.vertices[t[k]].cast<double>());
  }
  return box;
}

Overlap overlap(const Solid& mesh, const Solid& truth, const OverlapOptions& options) {
  OverlapOptions outer = options;
  ++outer.seed;
  const Grid near(truth.box, options.resolution), far(truth.box.merged(mesh.box), options.resolution);
  const Counts inside = OverlapCounter(mesh, truth, near, Box(), options).count();
  const Counts around = OverlapCounter(mesh, truth, far, truth.box, outer).count();
  const auto volume = [&](std::size_t Counts::*cells) {
    return static_cast<double>(inside.*cells) * near.cell.prod() +
           static_cast<double>(around.*cells) * far.cell.prod();
  };
  const double any = volume(&Counts::any), true_volume = volume(&Counts::truth);
  Overlap result;
  if (any > 0) result.iou = volume(&Counts::both) / any;
  if (!options.deep || !(true_volume > 0)) return result;
  result.false_outside_deep = volume(&Counts::lost) / true_volume;
  result.false_inside_deep = volume(&Counts::invented) / true_volume;
  return result;
}

}  // namespace vdbfuse
