// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/sampling.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kGrain = 4096;

// Area of all triangles up to and including each; one that is not finite counts as none.
std::vector<double> cumulativeAreas(const TriangleMesh& mesh) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>(), c = mesh.vertices[t[2]].cast<double>();
    const double area = 0.5 * (b - a).cross(c - a).norm();
    sums.push_back(sum += std::isfinite(area) ? area : 0.0);
  }
  return sums;
}

Eigen::Vector3d pointOf(const TriangleMesh& mesh, const Triangle& t, Random& random) {
  // The square root makes the distance from the first corner uniform by area.
  const double r = std::sqrt(random.uniform()), s = random.uniform();
  return (1 - r) * mesh.vertices[t[0]].cast<double>() + r * (1 - s) * mesh.vertices[t[1]].cast<double>() +
         r * s * mesh.vertices[t[2]].cast<double>();
}

}  // namespace

std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  const std::vector<double> sums = cumulativeAreas(mesh);
  if (sums.empty() || !(sums.back() > 0)) return {};
  std::vector<SurfaceSample> samples(count);
  // Where rounding goes beyond the end, the last triangle with an area is meant, not one without that follows
  // it.
  const auto last = std::lower_bound(sums.begin(), sums.end(), sums.back());
  parallelFor(count, kGrain, [&](std::size_t begin, std::size_t end) {
    Random random(seed, begin / kGrain);
    for (std::size_t i = begin; i < end; ++i) {
      const double target =
          sums.back() * ((static_cast<double>(i) + random.uniform()) / static_cast<double>(count));
      const auto found = std::min(std::upper_bound(sums.begin(), sums.end(), target), last);
      const auto triangle = static_cast<std::uint32_t>(found - sums.begin());
      samples[i] = {pointOf(mesh, mesh.triangles[triangle], random), triangle};
    }
  });
  return samples;
}

}  // namespace vdbfuse
