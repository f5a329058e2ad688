// SPDX-License-Identifier: Apache-2.0
// surface_benchmark [--mesh FILE ...] [--out FOLDER]: how exact surfaces are.
//   Sphere: `synth ball --preset kinect`, voxel 5 mm; exact depths (in millimetres), the sensor's noise,
//   noise and 5 % outliers; both methods. Bias and RMS of the vertices' distance from the sphere where it was
//   measured (z > 0.05, and supported), millimetres. With --out the scans are written there, for
//   peer_tsdf.py. Meshes: 48 views of 640x480, noise 0.001 z², 5 % outliers, voxel 0.003. Accuracy of 90 % of
//   the surface in voxels, completeness at one voxel, IoU, angle between its normals and the truth's.
//   Extraction: a field of 512³ voxels around a bumpy sphere; triangles per second and core.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/fusion/agreement.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/closest_point.h"
#include "vdbfuse/mesh/sampling.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/surface/extract.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;
namespace fs = std::filesystem;

struct SphereErrors {
  double bias = 0, rms = 0;
};

SphereErrors sphereErrors(const TriangleMesh& mesh) {
  constexpr double kRadius = 0.5, kMeasuredFrom = 0.05;
  double sum = 0, squares = 0, count = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v].z() < kMeasuredFrom || mesh.support[v] < kSupported) continue;
    const double error = 1000 * (mesh.vertices[v].cast<double>().norm() - kRadius);
    sum += error, squares += error * error, count += 1;
  }
  return {sum / count, std::sqrt(squares / count)};
}

void writeScan(const SyntheticScan& scan, const fs::path& folder) {
  if (fs::exists(folder)) return;
  MvsnetWriter writer(folder);
  for (std::size_t i = 0; i < scan.size(); ++i) writer.add(scan.render(i).view);
}

void measureSphere(const std::string& out) {
  std::printf(
      "| sphere, voxel 5 mm | method | bias mm | RMS mm | components | open edges "
      "|\n|---|---|---|---|---|---|\n");
  SynthOptions exact = kinectOptions(), noise = exact, outliers = exact;
  exact.noise_scale = 0;
  outliers.outliers = 0.05;
  const std::pair<const char*, SynthOptions> kinds[] = {
      {"exact", exact}, {"noise", noise}, {"outliers", outliers}};
  for (const auto& [name, synth] : kinds) {
    const SyntheticScan scan(makeScene("ball"), synth);
    if (!out.empty()) writeScan(scan, fs::path(out) / (std::string("ball-") + name));
    for (const Method method : {Method::Visibility, Method::Tsdf}) {
      ReconstructOptions options;
      options.voxel = 0.005;
      options.method = method;
      const Reconstruction result = reconstruct(scan.views(), options);
      const SphereErrors errors = sphereErrors(result.mesh);
      const TopologyReport t = topology(result.mesh);
      std::printf("| %s | %s | %.3f | %.3f | %zu | %zu |\n", name,
                  method == Method::Visibility ? "visibility" : "tsdf", errors.bias, errors.rms, t.components,
                  t.open_edges);
      std::fflush(stdout);
    }
  }
}

Eigen::Vector3d normalOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  return (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a).normalized();
}

// Degrees between the normals of the mesh and of the truth nearest to it: the median.
double medianNormalError(const TriangleMesh& mesh, const TriangleMesh& truth) {
  const ClosestPoint closest(truth);
  const std::vector<SurfaceSample> samples = sampleSurface(mesh, 100000, 1);
  std::vector<double> angles(samples.size());
  parallelFor(samples.size(), 1000, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfacePoint nearest = closest.query(samples[i].point);
      const double cosine = normalOf(mesh, samples[i].triangle).dot(normalOf(truth, nearest.triangle));
      angles[i] = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
    }
  });
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::nth_element(angles.begin(), middle, angles.end());
  return *middle;
}

void measureMeshes(const std::vector<std::string>& meshes) {
  std::printf(
      "\n| mesh, voxel 0.003 | accuracy 90 %% voxels | completeness | IoU | normals, median | components / "
      "open "
      "edges | surface step of all |\n|---|---|---|---|---|---|---|\n");
  for (const std::string& file : meshes) {
    SynthOptions synth;
    synth.outliers = 0.05;
    const SyntheticScan scan(sceneFromMesh(fs::path(file).stem().string(), readMesh(file)), synth);
    ReconstructOptions options;
    options.voxel = 0.003;
    const Reconstruction result = reconstruct(scan.views(), options);
    EvaluateOptions evaluation;
    evaluation.taus = {options.voxel};
    const Evaluation score = evaluate(result.mesh, scan.scene().truth, evaluation);
    double all = 0;
    for (const StepTime& step : result.steps) all += step.seconds;
    std::printf("| %s | %.3f | %.2f %% | %.4f | %.1f deg | %zu / %zu | %.2f of %.2f s |\n",
                scan.scene().name.c_str(), score.accuracy90 / options.voxel, 100 * score.completeness,
                score.iou.value_or(0), medianNormalError(result.mesh, scan.scene().truth),
                score.topology.components, score.topology.open_edges, result.steps.back().seconds, all);
    std::fflush(stdout);
  }
}

ScalarGrid bumpySphere() {
  constexpr double kRadius = 230;
  const auto distance = [](const Eigen::Vector3d& p) {
    return p.norm() - kRadius - 4 * std::sin(0.1 * p.x()) * std::sin(0.1 * p.y()) * std::sin(0.1 * p.z());
  };
  std::vector<Index3> origins;
  for (int x = -256; x < 256; x += 8)
    for (int y = -256; y < 256; y += 8)
      for (int z = -256; z < 256; z += 8) {
        if (std::abs(distance(Eigen::Vector3d(x + 3.5, y + 3.5, z + 3.5))) < 16)
          origins.emplace_back(x, y, z);
      }
  ScalarGrid field("surface", {1.0}, kUnknown, origins);
  field.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (int i = 0; i < ScalarGrid::kLeafSize; ++i)
      leaf.values[static_cast<std::size_t>(i)] =
          static_cast<float>(distance((leaf.origin + Index3(i >> 6, i >> 3 & 7, i & 7)).cast<double>()));
  });
  return field;
}

void measureExtraction() {
  const ScalarGrid field = bumpySphere();
  std::printf(
      "\n| extraction, threads | triangles | seconds | million triangles/s/core |\n|---|---|---|---|\n");
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    double best = 1e9;
    std::size_t triangles = 0;
    for (int run = 0; run < 5; ++run) {
      const auto begin = std::chrono::steady_clock::now();
      triangles = extractSurface(field).triangles.size();
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    std::printf("| %d | %zu | %.3f | %.2f |\n", threads, triangles, best,
                1e-6 * static_cast<double>(triangles) / best / threads);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How exact are the surfaces?");
  std::vector<std::string> meshes;
  std::string out;
  bool only_extraction = false;
  app.add_option("--mesh", meshes, "closed meshes to scan: anchor, armadillo, fertility");
  app.add_option("--out", out, "folder for the scans of the sphere")->check(CLI::ExistingDirectory);
  app.add_flag("--extraction", only_extraction, "only the speed of the extraction");
  CLI11_PARSE(app, argc, argv);
  if (!only_extraction) measureSphere(out), measureMeshes(meshes);
  measureExtraction();
}
