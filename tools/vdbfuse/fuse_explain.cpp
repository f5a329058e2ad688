// SPDX-License-Identifier: Apache-2.0
#include "fuse_explain.h"

#include <cstdio>

#include "vdbfuse/base/memory.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/simd.h"

namespace vdbfuse::tool {
namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string number(double value) { return text("%.6g", value); }

struct Run {
  const FuseRequest& request;
  const JudgedScan& scan;
  const Parameters& parameters;
};

std::string whyVoxel(const Run& run) {
  using From = Parameters::VoxelFrom;
  const Parameters& p = run.parameters;
  const CalibrationReport& c = run.scan.calibration;
  const double longest = p.domain.sizes().maxCoeff();
  switch (p.voxel_from) {
    case From::Voxel:
      return run.request.volume.empty() ? "given" : "that of the volume of --continue";
    case From::Resolution:
      return text("longest side of the domain %.4g / %d", longest, run.request.reconstruct.resolution);
    case From::PointSpacing:
      return text("distance of neighbouring measurements; the noise is %.3g", c.noise_scale);
    case From::Noise:
      return text("the noise; measurements lie %.3g from each other", c.point_spacing);
    case From::LongestSide:
      return text("longest side of the domain %.4g / 512; measurements lie %.3g from each other", longest,
                  c.point_spacing);
  }
  return "";
}

std::string whyLambda(const Run& run) {
  const double voxel = run.parameters.voxel, noise = run.scan.calibration.noise_scale;
  return text("0.6/max(voxel, noise): the %s %.4g is larger", voxel >= noise ? "voxel" : "noise",
              std::max(voxel, noise));
}

std::string whyNoise(const Run& run) {
  const CalibrationReport& c = run.scan.calibration;
  if (!run.request.judgement.empty()) return text("that of --judgement, at depth %.4g", c.median_depth);
  if (!run.request.sensor.sensor.empty()) return text("law of the sensor, at depth %.4g", c.median_depth);
  if (c.noise_exponent < 0)
    return text("from the matching of the photographs, at depth %.4g", c.median_depth);
  return text("from the overlap of the views, at depth %.4g; %s", c.median_depth,
              nameOfLaw(c.noise_exponent));
}

std::string whyOutliers(const Run& run) {
  if (run.request.sensor.no_reliability) return "--no-reliability";
  return run.request.judgement.empty() ? "judged by pixel; this is their mean" : "judged before, --judgement";
}

std::string boxText(const Box& box) {
  const Eigen::Vector3d a = box.min(), b = box.max();
  return text("%.4g,%.4g,%.4g,%.4g,%.4g,%.4g", a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
}

void addCut(const Run& run, std::vector<FoundValue>& found) {
  const Parameters& p = run.parameters;
  const double diagonal = p.domain.diagonal().norm();
  found.push_back({"lambda", number(p.cut.lambda), whyLambda(run)});
  if (!run.request.reconstruct.visibility_prior)
    found.push_back({"visibility-prior", number(p.evidence.visibility_prior),
                     "1 for 8 views or fewer, 0.5 for 24 or more; repetitions count by their weights"});
  if (!run.request.reconstruct.least_cost)
    found.push_back({"least-cost", number(p.cut.least_cost),
                     run.request.reconstruct.evidence.rule == EvidenceRule::Outside
                         ? "0.4 x noise/max(voxel, noise)"
                         : "none, as in the literature"});
  if (run.request.border == "auto")
    found.push_back({"border", nameOf(p.cut.border),
                     text("%zu of %zu sensors are inside the domain", p.sensors_inside, p.sensors)});
  if (run.request.thickness == "auto")
    found.push_back(
        {"thickness", number(p.evidence.thickness), text("0.11 x diagonal of the domain %.4g", diagonal)});
}

void addTsdf(const Run& run, std::vector<FoundValue>& found) {
  const std::string why = !run.request.volume.empty()        ? "that of the volume of --continue"
                          : run.request.truncation == "auto" ? "the larger of 4 voxels and 3 x the noise"
                                                             : "what stands for the share of outliers";
  found.push_back({"truncation", number(run.parameters.truncation), why});
  if (!run.request.volume.empty()) found.push_back({"method", "tsdf", "--continue"});
}

void addMachine(const Run& run, std::vector<FoundValue>& found) {
  const ScanPlan& plan = run.scan.plan;
  if (run.request.threads == 0) found.push_back({"threads", std::to_string(threadCount()), "all processors"});
  found.push_back({"memory", sizeText(plan.memory_budget), "80 % of what is free"});
  found.push_back({"simd", simdTargets().front(), "the best that this processor has"});
  if (!plan.survey) return;
  found.push_back({"(memory)", sizeText(plan.estimated_memory), "expected at the peak"});
  found.push_back({"(cells)", number(plan.cells), "expected"});
}

}  // namespace

std::vector<FoundValue> foundValues(const FuseRequest& request, const JudgedScan& scan,
                                    const Parameters& parameters, const std::string& format) {
  const Run run{request, scan, parameters};
  const CalibrationReport& c = scan.calibration;
  std::vector<FoundValue> found = {
      {"format", format, "what the input looks like"},
      {"voxel", number(parameters.voxel), whyVoxel(run)},
      {"resolution", number(parameters.domain.sizes().maxCoeff() / parameters.voxel),
       "longest side of the domain / voxel"},
      {"bbox", boxText(parameters.domain), "where reliable pixels of several views agree"},
      {"noise-scale", number(c.noise_scale), whyNoise(run)},
      {"outliers", number(c.outlier_share), whyOutliers(run)}};
  if (request.reconstruct.method == Method::Tsdf) {
    addTsdf(run, found);
  } else {
    addCut(run, found);
  }
  addMachine(run, found);
  found.push_back(
      {"(depths)", number(c.near) + " to " + number(c.far), "from the data, widened by the domain"});
  found.push_back({"(spacing)", number(c.point_spacing), "distance of neighbouring measurements"});
  found.push_back({"(confidence)", nameOf(c.confidence), "learned from what views say of each other"});
  return found;
}

}  // namespace vdbfuse::tool
