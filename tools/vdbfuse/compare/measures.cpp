// SPDX-License-Identifier: Apache-2.0
#include "compare/measures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/closest_point.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

// The value that so much of the area stays below.
double quantileByArea(const TriangleMesh& mesh, const std::vector<float>& values, double share) {
  const std::vector<double> areas = vertexAreas(mesh);
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return values[a] != values[b] ? values[a] < values[b] : a < b;
  });
  const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
  double sum = 0;
  for (const std::size_t i : order) {
    sum += areas[i];
    if (sum >= share * all) return values[i];
  }
  return 0;
}

// Upwards to two digits.
double roundedUp(double value) {
  if (!(value > 0) || !std::isfinite(value)) return 1;
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::ceil(value / digit - 1e-9) * digit;
}

// What mesh k is measured from; null when there is nothing else.
const TriangleMesh* targetOf(const MeasuredMeshes& all, std::size_t k) {
  if (!all.reference.triangles.empty()) return &all.reference;
  if (all.meshes.size() < 2) return nullptr;
  return &all.meshes[k == 0 ? 1 : 0].mesh;
}

void compareWithReference(const CompareRequest& request, const MeasuredMeshes& all, ShownMesh& shown,
                          MethodRecord& record) {
  shown.missing = vertexDistances(all.reference, ClosestPoint(shown.mesh));
  EvaluateOptions options;
  options.taus = request.taus;
  record.evaluation = evaluate(shown.mesh, all.reference, options);
}

}  // namespace

MeasuredMeshes measureMeshes(const CompareRequest& request, const fs::path& folder, TriangleMesh reference,
                             CompareRun& run, const Progress& progress) {
  MeasuredMeshes all;
  all.reference = std::move(reference);
  all.measured_from = all.reference.triangles.empty() ? "the other mesh" : "the reference";
  for (const MethodRecord& method : run.methods)
    all.meshes.push_back({method.name, readMesh(folder / method.mesh), {}, {}});
  ProgressStep step(progress, "measure", all.meshes.size());
  double distance = std::numeric_limits<double>::infinity(), support = 0;
  for (std::size_t k = 0; k < all.meshes.size(); ++k) {
    ShownMesh& shown = all.meshes[k];
    support = std::max(support, quantileByArea(shown.mesh, shown.mesh.support, 0.98));
    if (const TriangleMesh* target = targetOf(all, k)) {
      shown.distances = vertexDistances(shown.mesh, ClosestPoint(*target));
      distance = std::min(distance, quantileByArea(shown.mesh, shown.distances, 0.9));
    }
    if (!all.reference.triangles.empty()) compareWithReference(request, all, shown, run.methods[k]);
    step.advance();
  }
  all.largest_distance = roundedUp(3 * std::max(distance, run.voxel / 3)),
  all.largest_support = roundedUp(support);
  return all;
}

std::string lengthText(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", length);
  return text;
}

}  // namespace vdbfuse::tool
