// SPDX-License-Identifier: Apache-2.0
// What vdbfuse compare gives other programs: compare.json, and the meshes of the viewer.
#include "compare/page.h"
#include "evaluation_json.h"
#include "vdbfuse/io/glb.h"
#include "vdbfuse/surface/simplify.h"

namespace vdbfuse::tool {
namespace {

EmbeddedMesh embed(const ShownMesh& shown, std::size_t triangles) {
  TriangleMesh mesh = shown.mesh;
  // The place of the confidence, which follows from the support, carries distances through simplify().
  mesh.confidence = shown.distances;
  const std::size_t all = mesh.triangles.size();
  if (all > triangles) {
    simplify({triangles, 0, SimplifyOptions::Topology::MayChange}, mesh);
    mesh.normals = vertexNormals(mesh);
  }
  std::vector<VertexValues> more;
  if (!mesh.confidence.empty()) more.push_back({kDistanceAttribute, std::move(mesh.confidence)});
  mesh.confidence.clear();
  const std::size_t left = mesh.triangles.size();
  const std::string words = left == all ? std::to_string(all) + " triangles"
                                        : std::to_string(left) + " of " + std::to_string(all) + " triangles";
  return {{shown.name, glbBytes(mesh, more), words}, left, all};
}

}  // namespace

std::vector<EmbeddedMesh> embedMeshes(const MeasuredMeshes& measured, std::size_t triangles,
                                      const Progress& progress) {
  ProgressStep step(progress, "simplify", measured.meshes.size());
  std::vector<EmbeddedMesh> embedded;
  for (const ShownMesh& shown : measured.meshes) {
    embedded.push_back(embed(shown, triangles));
    step.advance();
  }
  return embedded;
}

std::string planeText(const SlicePlane& plane) {
  return std::string(1, static_cast<char>('x' + plane.axis)) + " = " + lengthText(plane.value);
}

Json compareJson(const CompareRequest& request, const CompareRun& run,
                 const std::vector<EmbeddedMesh>& embedded) {
  Json json = jsonOf("compare");
  json["input"] = {{"path", request.input.string()},
                   {"views", run.views},
                   {"width", run.width},
                   {"height", run.height},
                   {"format", run.format}};
  json["reference"] = request.reference.empty() ? Json() : Json(request.reference.string());
  json["voxel"] = run.voxel;
  json["slice"] = planeText(run.plane);
  json["memory_restarted"] = run.methods.front().measured == PeakMemory::Restarted;
  json["methods"] = Json::array();
  for (std::size_t k = 0; k < run.methods.size(); ++k) {
    const MethodRecord& m = run.methods[k];
    Json method = {{"name", m.name}, {"mesh_file", m.mesh.generic_string()}};
    method.update(m.fuse);
    for (const char* common : {"version", "command", "input"}) method.erase(common);
    method["seconds"] = m.seconds, method["shared_seconds"] = m.shared_seconds;
    method["own_peak_memory_bytes"] = m.own_peak_memory;
    method["mean_support"] = m.mean_support;
    method["evaluation"] = m.evaluation ? evaluationJson(*m.evaluation) : Json();
    method["viewer_triangles"] = embedded[k].triangles;
    json["methods"].push_back(std::move(method));
  }
  return json;
}

}  // namespace vdbfuse::tool
