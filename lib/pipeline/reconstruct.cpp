// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/reconstruct.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/cells.h"
#include "pipeline/fuse_judged.h"
#include "pipeline/steps.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/fusion/agreement.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/pipeline/judge_scan.h"
#include "vdbfuse/pipeline/parameters.h"
#include "vdbfuse/sensor/view_windows.h"
#include "vdbfuse/surface/extract.h"
#include "vdbfuse/surface/rim.h"
#include "vdbfuse/surface/simplify.h"
#include "vdbfuse/surface/trim.h"

namespace vdbfuse {
namespace {

// Cuts away what was asked for, and says what a reader of the mesh should know of it.
void finishMesh(const ReconstructOptions& options, Reconstruction& result) {
  TriangleMesh& mesh = result.mesh;
  char text[64];
  std::snprintf(text, sizeof text, "%.1f %% of the area invented", 100 * result.invented_area_share);
  if (options.method == Method::Visibility && options.trim == 0) mesh.comments.emplace_back("closed surface");
  if (options.method == Method::Visibility) mesh.comments.emplace_back(text);
  if (options.method == Method::Tsdf)
    mesh.comments.emplace_back("open: no surface where space is unknown (Curless-Levoy)");
  if (options.min_component > 0) result.components_dropped = dropSmallComponents(options.min_component, mesh);
  if (options.trim > 0) trimUnsupported(static_cast<float>(options.trim), mesh);
  if (options.simplify > 0 && !mesh.triangles.empty()) {
    result.simplify_error = simplify({options.simplify, 0}, mesh).error;
    mesh.normals = vertexNormals(mesh);
  }
}

// The minimum of (1): the paper's section 3 from the depth maps on.
void cutVisibility(const JudgedViews& judged, const Parameters& parameters, const ReconstructOptions& options,
                   const std::vector<int>& reduction, const Progress& progress, StepTimer& timer,
                   Reconstruction& result) {
  const Box& domain = parameters.domain;
  const GridFrame frame{parameters.voxel};
  timer.start("agreement");
  ScalarGrid support = countAgreement(judged, frame, domain, progress);  // C(x), eq. (3)

  timer.start("octree");
  Octree octree = buildOctree(support, kSupported, domain, octreeOptions(frame, result.calibration, options));

  timer.start("evidence");
  const EvidenceOptions& evidence_options = parameters.evidence;
  const CutOptions& cut_options = parameters.cut;
  const CellsWithEvidence cells =
      evaluateFromCoarseToFine(judged, support, std::move(octree), evidence_options,
                               {cut_options.lambda, cut_options.max_evidence}, progress);  // σ(x)

  timer.start("cut");
  Labelling cut =
      cutCells(cells.octree, cells.tiles, cells.support, cells.sigma, cut_options, progress);  // (1)
  const SpeckReport specks =
      removeSpecks(cells.octree, cells.tiles, std::pow(leastWidth(reduction, result.calibration, options), 3),
                   cut_options.border, cut.labels);
  const CavityReport cavities =
      fillUnseenCavities(cells.octree, cells.tiles, sensorPositions(judged), cut_options.border, cut.labels);

  timer.start("surface");
  SurfaceField surface =
      signedField(judged, {cells.octree, cells.tiles, cut.labels, cells.support, cells.sigma, cut_options},
                  support, {options.smoothing_voxels, kSupported, options.completion}, progress);
  result.mesh = extractSurface(surface.distance, progress);
  describeVertices(support, options.mu, result);
  finishMesh(options, result);

  result.grid = describeGrid(cells.octree, support, domain);
  result.cut = CutReportSummary{cut.flow,
                                cut.certified,
                                cut.nodes,
                                cut.arcs,
                                cut.energy,
                                cut_options.lambda,
                                cut_options.least_cost,
                                evidence_options.visibility_prior,
                                evidence_options.thickness,
                                cut_options.border,
                                cavities,
                                specks,
                                surface.unresolved,
                                surface.completion};
  if (options.grids == ReconstructOptions::Grids::Drop) return;
  result.grids = levelGrids(cells.octree, cells.sigma, "sigma", kUnknown);
  result.grids.push_back(discontinuityCost(support, cut_options.mu, cut_options.least_cost));
  result.grids.push_back(std::move(support));
  result.grids.push_back(std::move(surface.distance));
}

TsdfVolume startVolume(const Parameters& parameters, const ReconstructOptions& options) {
  if (options.tsdf.start) {
    TsdfVolume volume = std::move(*options.tsdf.start);
    volume.growDomain(parameters.domain);
    return volume;
  }
  TsdfOptions tsdf;
  tsdf.truncation = parameters.truncation;
  tsdf.domain = parameters.domain;
  return {GridFrame{parameters.voxel}, tsdf};
}

// Views that are believed as far as they were judged.
void integrateViews(const JudgedViews& judged, const TsdfMethod& method, const Progress& progress,
                    TsdfVolume& volume) {
  const auto with_each = [&](const char* name, const auto& use) {
    ProgressStep step(progress, name, judged.views.size());
    for (const JudgedView& view : judged.views) {
      const Image<float> weights =
          measurementWeights(view, judged.sensor.noise, volume.frame().voxel, method.weights);
      use(TsdfInput{view, view.depth, &weights});
      letGo(view);
      step.advance();
    }
  };
  with_each("integrate", [&](const TsdfInput& input) { volume.integrate(input); });
  if (method.carving == TsdfMethod::Carving::On)
    with_each("carve", [&](const TsdfInput& input) { volume.carve(input); });
}

void fuseTsdf(const JudgedViews& judged, const Parameters& parameters, const ReconstructOptions& options,
              const Progress& progress, StepTimer& timer, Reconstruction& result) {
  timer.start("integrate");
  const TsdfMethod& method = options.tsdf;
  TsdfVolume volume = startVolume(parameters, options);
  integrateViews(judged, method, progress, volume);
  result.truncation = volume.options().truncation;

  timer.start("surface");
  ScalarGrid distance = volume.distance(static_cast<float>(method.least_weight));
  result.grid = describeGrid(distance, parameters.domain);
  for (int pass = 0; pass < method.close_gaps; ++pass) distance = closeGaps(distance);
  result.mesh = extractSurface(distance, progress);
  if (method.trim_rim > 0) trimRim(method.trim_rim, result.mesh);
  result.mesh.normals = vertexNormals(result.mesh);
  volume.describeVertices(result.mesh);
  finishMesh(options, result);
  if (options.grids == ReconstructOptions::Grids::Keep) result.grids = volume.grids();
}

}  // namespace

Reconstruction reconstruct(const ViewSequence& views, const ReconstructOptions& options,
                           const Progress& progress) {
  ScanPlan plan = planReconstruction(views, options, progress);
  return reconstruct(judgeScan(views, options, std::move(plan), progress), options, progress);
}

Reconstruction reconstruct(JudgedScan scan, const ReconstructOptions& options, const Progress& progress) {
  requireUsable(options);
  useOptions(options, scan);
  return fuseJudged(scan, options, progress);
}

void useOptions(const ReconstructOptions& options, JudgedScan& scan) {
  if (options.domain) useDomain(*options.domain, scan.judgement);
  scan.judgement.judged.sensor.prior_decay = options.prior_decay;
}

Reconstruction fuseJudged(const JudgedScan& scan, const ReconstructOptions& options,
                          const Progress& progress) {
  Reconstruction result;
  StepTimer timer;
  result.width = scan.width, result.height = scan.height;
  result.memory = {scan.plan.memory_budget, scan.plan.estimated_memory, scan.plan.window_bytes};
  result.calibration = scan.calibration;
  const JudgedViews& judged = scan.judgement.judged;
  const Parameters parameters = resolveParameters(scan, options);

  if (options.method == Method::Tsdf) {
    fuseTsdf(judged, parameters, options, progress, timer, result);
  } else {
    cutVisibility(judged, parameters, options, scan.plan.reduction, progress, timer, result);
  }
  if (result.mesh.triangles.empty() && (options.trim > 0 || options.min_component > 0))
    throw Error("the result is empty: trim or min_component leaves nothing of the surface");
  if (result.mesh.triangles.empty()) {
    throw Error(
        "the result is empty: no surface inside the domain is supported by the depth maps "
        "(check units and poses with 'vdbfuse info', or give --bbox)");
  }
  result.steps = scan.steps;
  for (StepTime& step : timer.finish()) result.steps.push_back(std::move(step));
  return result;
}

ColorReport colorReconstruction(const ViewSequence& views, Reconstruction& result, const Progress& progress) {
  constexpr double kWidths = 3;  // of the noise, or voxels: the same surface
  StepTimer timer;
  timer.start("colour");
  const double tolerance = kWidths * std::max(result.grid.voxel, result.calibration.noise_scale);
  const ColorReport report = colorVertices(views, {tolerance}, result.mesh, progress);
  for (StepTime& step : timer.finish()) result.steps.push_back(std::move(step));
  return report;
}

}  // namespace vdbfuse
