// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/aspect.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

double aspectOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double sides[] = {(b - a).norm(), (c - b).norm(), (a - c).norm()};
  const double area = 0.5 * (b - a).cross(c - a).norm();
  const double longest = std::max({sides[0], sides[1], sides[2]});
  return longest * (sides[0] + sides[1] + sides[2]) / (4 * std::sqrt(3.0) * area);
}

}  // namespace

AspectReport aspects(const TriangleMesh& mesh) {
  constexpr std::size_t kTrianglesPerTask = 16384;
  if (mesh.triangles.empty()) return {};
  std::vector<double> all(mesh.triangles.size());
  parallelFor(all.size(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
        return mesh.vertices[mesh.triangles[i][k]].cast<double>();
      };
      all[i] = aspectOf(corner(0), corner(1), corner(2));
    }
  });
  const auto quantile = [&](double share) {
    const auto nth = all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(all.size() - 1));
    std::nth_element(all.begin(), nth, all.end());
    return *nth;
  };
  const double median = quantile(0.5), high = quantile(0.99);
  return {median, high, quantile(1)};
}

}  // namespace vdbfuse
