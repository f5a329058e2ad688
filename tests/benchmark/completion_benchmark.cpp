// SPDX-License-Identifier: Apache-2.0
// completion_benchmark [--mesh FILE ...]: does the grid show in what was invented? Each scene is seen from
// one side only, reconstructed, and once more with all cameras turned by 30° about (1, 2, 3); the second mesh
// is turned back. With the isotropic completion and without.
//   fill: triangles of which no corner is supported.
//   distance: from samples of one fill to the other mesh, both ways together, voxels.
//   bends: share of the fill's edges longer than half a voxel along which the normal turns by more than 0.25
//          rad a voxel.
//   on axis: share of the fill's area whose normal is within 6° of a grid axis (both orientations together; a
//          sphere's area would have 3.3 %).
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/fusion/agreement.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/closest_point.h"
#include "vdbfuse/mesh/sampling.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;

ViewSequence turned(const SyntheticScan& scan, const Eigen::Matrix3d& rotation) {
  std::vector<ViewHeader> headers;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    headers.push_back(scan.header(i));
    RigidTransform pose = RigidTransform::Identity();
    pose.linear() = rotation;
    headers.back().world_from_camera = pose * headers.back().world_from_camera;
  }
  return {headers, [scan](std::size_t i) { return scan.render(i).view.map; }};
}

void turn(TriangleMesh& mesh, const Eigen::Matrix3f& rotation) {
  for (Eigen::Vector3f& v : mesh.vertices) v = rotation * v;
  for (Eigen::Vector3f& n : mesh.normals) n = rotation * n;
}

// The triangles without a supported corner, and further than so many rings of triangles from one.
TriangleMesh fillOf(const TriangleMesh& mesh, int rings) {
  TriangleMesh fill = mesh;
  std::vector<bool> measured(mesh.vertices.size());
  for (std::size_t v = 0; v < measured.size(); ++v) measured[v] = mesh.support[v] >= kSupported;
  const auto touches = [&](const Triangle& t) { return measured[t[0]] || measured[t[1]] || measured[t[2]]; };
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<bool> more = measured;
    for (const Triangle& t : mesh.triangles) {
      if (touches(t)) more[t[0]] = more[t[1]] = more[t[2]] = true;
    }
    measured = std::move(more);
  }
  std::erase_if(fill.triangles, touches);
  return fill;
}

void appendDistances(const TriangleMesh& from, const TriangleMesh& to, double voxel,
                     std::vector<double>& out) {
  const ClosestPoint closest(to);
  for (const SurfaceSample& sample : sampleSurface(from, 50000, 1))
    out.push_back(closest.query(sample.point).distance / voxel);
}

struct Shape {
  double bends = 0, edges = 0, on_axis = 0, area = 0;
};

// REQUIRES: the mesh in the coordinates of the grid.
void addShape(const TriangleMesh& fill, double voxel, Shape& shape) {
  constexpr double kLongEnough = 0.5, kBend = 0.25, kAngle = 6 * std::numbers::pi / 180;
  const double cosine = std::cos(kAngle);
  for (const Triangle& t : fill.triangles) {
    const Eigen::Vector3d a = fill.vertices[t[0]].cast<double>(), b = fill.vertices[t[1]].cast<double>(),
                          c = fill.vertices[t[2]].cast<double>();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double area = 0.5 * normal.norm();
    shape.area += area;
    if (area > 0 && normal.cwiseAbs().maxCoeff() >= cosine * 2 * area) shape.on_axis += area;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = t[static_cast<std::size_t>(k)], q = t[static_cast<std::size_t>((k + 1) % 3)];
      const double length = (fill.vertices[p] - fill.vertices[q]).cast<double>().norm() / voxel;
      if (length < kLongEnough) continue;
      const double angle = std::acos(
          std::clamp(fill.normals[p].cast<double>().dot(fill.normals[q].cast<double>()), -1.0, 1.0));
      shape.edges += 1, shape.bends += angle / length > kBend ? 1 : 0;
    }
  }
}

double secondsOf(const Reconstruction& result, const std::string& name) {
  double sum = 0;
  for (const StepTime& step : result.steps) sum += name.empty() || step.name == name ? step.seconds : 0;
  return sum;
}

void measure(const std::string& name, const SyntheticScan& scan, CompletionOptions::Kind kind,
             const std::string& folder) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(std::numbers::pi / 6, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  ReconstructOptions options;
  options.voxel = 0.005;
  options.domain = Box(Eigen::Vector3d::Constant(-0.75), Eigen::Vector3d::Constant(0.75));
  options.completion.kind = kind;
  Reconstruction straight = reconstruct(scan.views(), options);
  Reconstruction other = reconstruct(turned(scan, rotation), options);
  Shape shape;
  TriangleMesh first = fillOf(straight.mesh, 0), second = fillOf(other.mesh, 0);
  addShape(first, options.voxel, shape), addShape(second, options.voxel, shape);
  Shape inner;
  constexpr int kRim = 5;
  addShape(fillOf(straight.mesh, kRim), options.voxel, inner);
  addShape(fillOf(other.mesh, kRim), options.voxel, inner);
  turn(other.mesh, rotation.transpose().cast<float>()), turn(second, rotation.transpose().cast<float>());
  std::vector<double> distances;
  appendDistances(first, other.mesh, options.voxel, distances);
  appendDistances(second, straight.mesh, options.voxel, distances);
  std::sort(distances.begin(), distances.end());
  const auto at = [&](double share) {
    return distances[static_cast<std::size_t>(share * static_cast<double>(distances.size() - 1))];
  };
  EvaluateOptions evaluation;
  evaluation.taus = {0.01};
  const Evaluation score = evaluate(straight.mesh, scan.scene().truth, evaluation);
  const bool isotropic = kind == CompletionOptions::Kind::Isotropic;
  std::printf(
      "| %s, %s | %.2f / %.2f / %.2f | %.2f / %.2f %% | %.1f %% | %.4f | %.4f | %zu / %zu | %.2f of %.2f s "
      "|\n",
      name.c_str(), isotropic ? "isotropic" : "none", at(0.5), at(0.99), at(1.0),
      100 * shape.bends / shape.edges, 100 * inner.bends / inner.edges, 100 * shape.on_axis / shape.area,
      score.iou.value_or(0), score.scores[0].fscore, score.topology.components, score.topology.open_edges,
      secondsOf(straight, "surface"), secondsOf(straight, ""));
  std::fflush(stdout);
  if (folder.empty()) return;
  const std::string file = folder + "/" + name + (isotropic ? "-isotropic" : "-none");
  writeMesh(file + ".ply", straight.mesh), writeMesh(file + "-turned.ply", other.mesh);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Does the grid show in what was invented?");
  std::vector<std::string> meshes;
  std::string folder;
  app.add_option("--mesh", meshes, "closed meshes, seen from the front beside the sphere seen from above");
  app.add_option("--out", folder, "folder for all meshes, to be looked at")->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  std::printf(
      "| scene, completion | distance: median / 99 %% / max | bends | on axis | IoU | F(.01) | components / "
      "open edges | surface step |\n|---|---|---|---|---|---|---|---|\n");
  SynthOptions options;
  options.views = 24;
  for (std::size_t i = 0; i <= meshes.size(); ++i) {
    options.arc = i == 0 ? Arc::Upper : Arc::Front;
    const Scene scene =
        i == 0 ? makeScene("sphere")
               : sceneFromMesh(std::filesystem::path(meshes[i - 1]).stem().string(), readMesh(meshes[i - 1]));
    const SyntheticScan scan(scene, options);
    for (const auto kind : {CompletionOptions::Kind::None, CompletionOptions::Kind::Isotropic})
      measure(scan.scene().name, scan, kind, folder);
  }
}
