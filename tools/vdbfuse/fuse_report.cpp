// SPDX-License-Identifier: Apache-2.0
#include "fuse_report.h"

#include <cstdio>

#include "vdbfuse/base/memory.h"
#include "vdbfuse/mesh/aspect.h"

namespace vdbfuse::tool {
namespace {

const char* nameOf(EvidenceRule rule) {
  switch (rule) {
    case EvidenceRule::Outside:
      return "outside";
    case EvidenceRule::Paper:
      return "paper";
    case EvidenceRule::NoSelfOcclusion:
      return "no-self-occlusion";
    case EvidenceRule::Constant:
      return "constant";
  }
  return "";
}

const char* nameOf(Method method) { return method == Method::Visibility ? "visibility" : "tsdf"; }

Json json(const Box& box) {
  return {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
}

Json weightsJson(const WeightOptions& weights) {
  Json names = Json::array();
  if (weights.confidence) names.push_back("confidence");
  if (weights.noise) names.push_back("noise");
  if (weights.incidence) names.push_back("incidence");
  if (weights.silhouette) names.push_back("silhouette");
  return names;
}

Json optionsJson(const Reconstruction& result, const FuseContext& context) {
  const ReconstructOptions& o = context.options;
  Json j = {{"method", nameOf(o.method)},
            {"voxel", result.grid.voxel},
            {"bbox", json(result.grid.domain)},
            {"noise", o.noise_shape.name},
            {"outliers", o.outliers ? Json(*o.outliers) : Json("auto")},
            {"denial", o.judge.denial == JudgeOptions::Denial::Examine ? "examine" : "skip"},
            {"judgement", context.judgement.empty() ? Json(nullptr) : Json(context.judgement.string())},
            {"rule", nameOf(o.evidence.rule)},
            {"visibility", o.evidence.visibility},
            {"prior", o.evidence.prior},
            {"balloon", o.evidence.balloon},
            {"mask_error", o.evidence.mask_error},
            {"depth_prior", o.prior_decay},
            {"window_px", o.window_px},
            {"trim", o.trim},
            {"min_component", o.min_component},
            {"simplify", o.simplify},
            {"mu", o.mu}};
  if (o.method == Method::Tsdf)
    j.update({{"truncation", result.truncation},
              {"carve", o.tsdf.carving == TsdfMethod::Carving::On},
              {"weights", weightsJson(o.tsdf.weights)},
              {"min_weight", o.tsdf.least_weight},
              {"close_gaps", o.tsdf.close_gaps},
              {"trim_rim", o.tsdf.trim_rim}});
  if (result.cut)
    j.update({{"completion", result.cut->completion ? "isotropic" : "none"},
              {"visibility_prior", result.cut->visibility_prior},
              {"lambda", result.cut->lambda},
              {"least_cost", result.cut->least_cost},
              {"thickness", result.cut->thickness},
              {"border", nameOf(result.cut->border)}});
  return j;
}

Json calibrationJson(const CalibrationReport& c) {
  return {{"noise_scale", c.noise_scale},
          {"noise_law", nameOfLaw(c.noise_exponent)},
          {"median_depth", c.median_depth},
          {"point_spacing", c.point_spacing},
          {"near", c.near},
          {"far", c.far},
          {"miss_rate", c.miss_rate},
          {"outlier_share", c.outlier_share},
          {"confidence_direction", nameOf(c.confidence)}};
}

Json meshJson(const Reconstruction& result, const TopologyReport& t) {
  const AspectReport aspect = aspects(result.mesh);
  return {{"vertices", result.mesh.vertices.size()},
          {"triangles", result.mesh.triangles.size()},
          {"components", t.components},
          {"open_edges", t.open_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"nonmanifold_vertices", t.nonmanifold_vertices},
          {"euler_number", t.euler_number},
          {"zero_area_triangles", t.zero_area_triangles},
          {"aspect_median", aspect.median},
          {"aspect_99", aspect.quantile99},
          {"invented_area_share", result.invented_area_share},
          {"components_dropped", result.components_dropped},
          {"simplify_error", result.simplify_error},
          {"colored", !result.mesh.colors.empty()}};
}

Json stepsWithMemory(const std::vector<StepTime>& steps) {
  Json list = stepsJson(steps);
  for (std::size_t i = 0; i < steps.size(); ++i) list[i]["peak_memory_bytes"] = steps[i].peak_memory_bytes;
  return list;
}

}  // namespace

double totalSeconds(const std::vector<StepTime>& steps) {
  double sum = 0;
  for (const StepTime& s : steps) sum += s.seconds;
  return sum;
}

Json fuseJson(const Reconstruction& result, const FuseContext& context) {
  Json j = jsonOf("fuse");
  j["options"] = optionsJson(result, context);
  j["input"] = {{"path", context.input.string()},
                {"views", context.views},
                {"width", result.width},
                {"height", result.height},
                {"format", context.format}};
  if (context.stereo) j["stereo"] = {{"views", jsonOf(*context.stereo)}};
  j["calibration"] = calibrationJson(result.calibration);
  j["grid"] = {{"voxel", result.grid.voxel},
               {"active", result.grid.active},
               {"leaves", result.grid.leaves},
               {"cells", result.grid.cells},
               {"levels", result.grid.cells_by_level}};
  if (result.cut) {
    const CutEnergy& e = result.cut->energy;
    j["energy"] = {
        {"total", e.surface + e.volume}, {"surface", e.surface}, {"volume", e.volume}, {"metric", "faces"}};
    j["cut"] = {{"flow", result.cut->flow},
                {"certified", result.cut->certified},
                {"nodes", result.cut->nodes},
                {"arcs", result.cut->arcs},
                {"cavities_filled", result.cut->cavities.filled},
                {"cavities_volume", result.cut->cavities.volume},
                {"specks_removed", result.cut->specks.removed},
                {"specks_volume", result.cut->specks.volume},
                {"unresolved_removed", result.cut->unresolved}};
  }
  if (result.cut && result.cut->completion) {
    const CompletionReport& c = *result.cut->completion;
    j["completion"] = {
        {"primal", c.primal}, {"dual", c.dual}, {"area", c.area}, {"iterations", c.iterations}};
  }
  j["mesh"] = meshJson(result, context.topology);
  j["steps"] = stepsWithMemory(result.steps);
  j["peak_memory_bytes"] = peakMemoryBytes();
  j["memory"] = {{"budget_bytes", result.memory.budget},
                 {"estimated_bytes", result.memory.estimated},
                 {"view_window_bytes", result.memory.window}};
  return j;
}

void printPlan(const ScanPlan& plan, Method method) {
  if (!plan.survey) return;
  std::fprintf(stderr, "voxel %.4g, about %.2g %s and %s of memory (%s may be used)%s\n", plan.voxel,
               plan.cells, method == Method::Tsdf ? "voxels" : "cells",
               sizeText(plan.estimated_memory).c_str(), sizeText(plan.memory_budget).c_str(),
               plan.window_bytes > 0 ? "; the depth maps lie in a file and pass by" : "");
}

void printFuseReport(const Reconstruction& result, const FuseContext& context,
                     const std::filesystem::path& output) {
  const TopologyReport& t = context.topology;
  const CalibrationReport& c = result.calibration;
  std::printf("%s: %zu vertices, %zu triangles, %zu component%s, %zu open edges\n", output.string().c_str(),
              result.mesh.vertices.size(), result.mesh.triangles.size(), t.components,
              t.components == 1 ? "" : "s", t.open_edges);
  std::printf("voxel %.4g, noise %.3g at depth %.3g (%s), outliers %.1f %%, confidence: %s\n",
              result.grid.voxel, c.noise_scale, c.median_depth, nameOfLaw(c.noise_exponent),
              100 * c.outlier_share, nameOf(c.confidence));
  if (result.cut) {
    std::printf("%zu cells, flow %lld%s, border %s, %.0f %% of the area invented\n", result.grid.cells,
                static_cast<long long>(result.cut->flow),
                result.cut->certified ? " (certified)" : " (NOT CERTIFIED)", nameOf(result.cut->border),
                100 * result.invented_area_share);
  }
  std::printf("%.1f s, %.0f MiB\n", totalSeconds(result.steps),
              static_cast<double>(peakMemoryBytes()) / (1 << 20));
  if (result.cut && result.invented_area_share > 1.0 / 3) {
    std::fprintf(
        stderr,
        "note: more than a third of the surface was invented, not measured (--trim 0.3 cuts it away)\n");
  }
}

}  // namespace vdbfuse::tool
