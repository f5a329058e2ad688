// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/simplify.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

struct Attempt {
  std::vector<Triangle> triangles;
  float error = 0;  // relative to the extent of the mesh
};

Attempt attempt(const TriangleMesh& mesh, std::size_t triangles, float error) {
  Attempt result{std::vector<Triangle>(mesh.triangles.size()), 0};
  const std::size_t indices =
      meshopt_simplify(result.triangles.front().data(), mesh.triangles.front().data(),
                       3 * mesh.triangles.size(), mesh.vertices.front().data(), mesh.vertices.size(),
                       sizeof(Eigen::Vector3f), 3 * triangles, error, 0, &result.error);
  result.triangles.resize(indices / 3);
  return result;
}

bool isAsGood(const TopologyReport& after, const TopologyReport& before) {
  return after.open_edges <= before.open_edges && after.nonmanifold_edges <= before.nonmanifold_edges &&
         after.nonmanifold_vertices <= before.nonmanifold_vertices &&
         after.inconsistent_edges <= before.inconsistent_edges && after.degenerate_triangles == 0 &&
         after.components == before.components && after.euler_number == before.euler_number;
}

}  // namespace

SimplifyReport simplify(const SimplifyOptions& options, TriangleMesh& mesh) {
  if (options.triangles == 0 && !(options.tolerance > 0))
    throw InvalidArgument("options", "neither a number of triangles nor a tolerance is given");
  if (mesh.triangles.size() <= options.triangles || mesh.triangles.empty()) return {mesh.triangles.size(), 0};
  const float extent =
      meshopt_simplifyScale(mesh.vertices.front().data(), mesh.vertices.size(), sizeof(Eigen::Vector3f));
  const float error = options.tolerance > 0 ? static_cast<float>(options.tolerance) / extent
                                            : std::numeric_limits<float>::max();
  const bool keeps = options.topology == SimplifyOptions::Topology::Keep;
  const TopologyReport before = keeps ? topology(mesh) : TopologyReport();
  TriangleMesh result = mesh;
  // From what was asked for towards the mesh as it is, until nothing is broken.
  for (std::size_t target = options.triangles; target < mesh.triangles.size();
       target += (mesh.triangles.size() - target + 7) / 8) {
    Attempt tried = attempt(mesh, target, error);
    result.triangles = std::move(tried.triangles);
    if (keeps && !isAsGood(topology(result), before)) continue;
    mesh = std::move(result);
    dropUnusedVertices(mesh);
    return {mesh.triangles.size(), static_cast<double>(tried.error) * extent};
  }
  return {mesh.triangles.size(), 0};
}

}  // namespace vdbfuse
