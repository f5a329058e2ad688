// SPDX-License-Identifier: Apache-2.0
#include "overlap.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

struct Counts {
  std::size_t both = 0, any = 0;
};

struct Cells {
  Eigen::Matrix<std::size_t, 3, 1> count;
  Vector3d size;
};

// Nearly cubic, `resolution` of them along the longest side.
Cells cellsOf(const Box& box, int resolution) {
  const Vector3d sides = box.sizes();
  Cells cells;
  for (int k = 0; k < 3; ++k) {
    const double wanted = std::ceil(resolution * sides[k] / sides.maxCoeff() - 1e-9);
    cells.count[k] = static_cast<std::size_t>(std::max(1.0, wanted));
    cells.size[k] = sides[k] / static_cast<double>(cells.count[k]);
  }
  return cells;
}

// Calls `look(point, counts)` for a random point of each cell. A row of cells is one stream of random
// numbers.
Counts countOver(const Box& box, const Cells& cells, std::uint64_t seed,
                 const std::function<void(const Vector3d&, Counts&)>& look) {
  const std::size_t rows = cells.count.y() * cells.count.z();
  std::vector<Counts> parts(rows);
  parallelFor(rows, 1, [&](std::size_t row, std::size_t) {
    Random random(seed, row);
    for (std::size_t x = 0; x < cells.count.x(); ++x) {
      const double u = random.uniform(), v = random.uniform(), w = random.uniform();
      const Vector3d cell(static_cast<double>(x) + u, static_cast<double>(row % cells.count.y()) + v,
                          static_cast<double>(row / cells.count.y()) + w);
      look(box.min() + cells.size.cwiseProduct(cell), parts[row]);
    }
  });
  Counts total;
  for (const Counts& part : parts) {
    total.both += part.both;
    total.any += part.any;
  }
  return total;
}

}  // namespace

Box finiteBox(const TriangleMesh& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) {
    const bool finite = std::all_of(t.begin(), t.end(), [&](auto v) { return mesh.vertices[v].allFinite(); });
    for (std::size_t k = 0; finite && k < 3; ++k) box.extend(mesh.vertices[t[k]].cast<double>());
  }
  return box;
}

std::optional<double> intersectionOverUnion(const WindingNumber& mesh, const WindingNumber& truth,
                                            const OverlapGrid& grid) {
  const Cells near = cellsOf(grid.truth_box, grid.resolution);
  const Counts in_truth_box =
      countOver(grid.truth_box, near, grid.seed, [&](const Vector3d& p, Counts& counts) {
        const bool in_mesh = grid.mesh_box.contains(p) && mesh.inside(p), in_truth = truth.inside(p);
        counts.both += in_mesh && in_truth;
        counts.any += in_mesh || in_truth;
      });
  const Box joint = grid.truth_box.merged(grid.mesh_box);
  const Cells far = cellsOf(joint, grid.resolution);
  const Counts around = countOver(joint, far, grid.seed + 1, [&](const Vector3d& p, Counts& counts) {
    if (grid.truth_box.contains(p) || !grid.mesh_box.contains(p)) return;
    counts.any += mesh.inside(p);
  });
  const double both = static_cast<double>(in_truth_box.both) * near.size.prod();
  const double any = static_cast<double>(in_truth_box.any) * near.size.prod() +
                     static_cast<double>(around.any) * far.size.prod();
  if (!(any > 0)) return std::nullopt;
  return both / any;
}

}  // namespace vdbfuse
