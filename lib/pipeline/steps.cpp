// SPDX-License-Identifier: Apache-2.0
#include "pipeline/steps.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/agreement.h"
#include "vdbfuse/fusion/point_spacing.h"
#include "vdbfuse/sensor/reduce.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

// A default voxel never makes the longest side of the domain longer than this.
constexpr double kDefaultLongestSide = 512;
constexpr double kLambdaPerVoxel = 0.6;
// ρ₀ where the noise is wider than the voxel. ρ₀/λ, the width of a fold that evidence 1 just pays for, is
// then ⅔ of the noise whatever the voxel.
constexpr double kLeastCostOfNoise = 0.4;
// Denied by all of n views, a place has the evidence −a log n: with a of its own 8 views hold thin parts as
// well as 72 do, and 72 do not cast shadows as solid as those of 8.
constexpr double kFewViews = 8, kPriorOfFewViews = 1.0, kManyViews = 24, kPriorOfManyViews = 0.5;
constexpr double kThicknessPerDiagonal = 0.11;

double visibilityPriorOf(const JudgedViews& judged) {
  double views = 0;  // that are not repetitions
  for (const JudgedView& view : judged.views) views += view.weight;
  const double share = (views - kFewViews) / (kManyViews - kFewViews);
  return std::lerp(kPriorOfFewViews, kPriorOfManyViews, std::clamp(share, 0.0, 1.0));
}

double scaleAtExponent(const NoiseLaw& law, double typical, int exponent) {
  return law.at(typical) / std::pow(typical, exponent);
}

NoiseLaw lawThrough(double scale, double typical, int exponent) {
  const double factor = scaleAtExponent({scale, 0, 0}, typical, exponent);
  if (exponent == 0) return {factor, 0, 0};
  return exponent == 1 ? NoiseLaw{0, factor, 0} : NoiseLaw{0, 0, factor};
}

}  // namespace

std::vector<std::string> validate(const ReconstructOptions& options) {
  std::vector<std::string> problems = validate(options.evidence);
  const auto require = [&](bool good, const char* sentence) {
    if (!good) problems.emplace_back(sentence);
  };
  require(options.voxel >= 0 && std::isfinite(options.voxel), "voxel must be positive");
  require(options.resolution >= 0, "resolution must be positive");
  require(options.voxel == 0 || options.resolution == 0, "voxel and resolution exclude each other");
  require(!options.domain || !options.domain->isEmpty(), "the box of the domain is empty");
  require(options.max_level >= 0 && options.max_level <= 6, "max_level must lie in 0 ... 6");
  require(options.noise_scale >= 0, "noise_scale must be positive");
  require(options.noise_scale == 0 || !options.noise, "noise and noise_scale exclude each other");
  require(options.window_px >= 0, "window_px must not be negative");
  require(options.prior_decay >= 0, "prior_decay must not be negative");
  require(options.thickness.value_or(0) >= 0, "thickness must not be negative");
  require(options.visibility_prior.value_or(1) > 0, "visibility_prior must be positive");
  require(!options.outliers || (*options.outliers >= 0 && *options.outliers < 1),
          "outliers must lie in [0, 1)");
  require(options.mu >= 0 && options.lambda >= 0, "mu and lambda must not be negative");
  require(!options.least_cost || (*options.least_cost >= 0 && *options.least_cost <= 1),
          "least_cost must lie in [0, 1]");
  require(options.smoothing_voxels >= 0 && options.smoothing_voxels <= 2,
          "smoothing_voxels must lie in [0, 2]");
  require(options.trim >= 0, "trim must not be negative");
  require(options.min_component >= 0, "min_component must not be negative");
  require(options.tsdf.truncation >= 0, "truncation must be positive");
  require(!options.tsdf.start || options.voxel == options.tsdf.start->frame().voxel,
          "voxel must be that of the volume to go on with");
  require(options.tsdf.least_weight >= 0, "least_weight must not be negative");
  require(options.tsdf.close_gaps >= 0 && options.tsdf.trim_rim >= 0,
          "close_gaps and trim_rim must not be negative");
  return problems;
}

void requireUsable(const ReconstructOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
}

void requireUsable(const ViewSequence& views, const ReconstructOptions& options) {
  requireUsable(options);
  if (views.empty()) throw InvalidArgument("views", "there are none");
}

std::vector<View> loadViews(const ViewSequence& sequence, JudgedScan& scan, const Progress& progress) {
  if (scan.plan.window_bytes > 0) scan.memory = std::make_shared<ScratchMemory>(scan.plan.window_bytes);
  scan.width = static_cast<std::size_t>(imageWidth(sequence.header(0).projection));
  scan.height = static_cast<std::size_t>(imageHeight(sequence.header(0).projection));
  std::vector<View> views(sequence.size());
  ProgressStep step(progress, "load views", sequence.size());
  parallelFor(sequence.size(), 1, [&](std::size_t i, std::size_t) {
    View view = sequence.load(i);
    view.map.color = {};
    if (view.map.alternatives.empty()) view = reduced(std::move(view), scan.plan.reduction[i]);
    if (scan.memory) keepIn(scan.memory.get(), view), letGo(view);
    views[i] = std::move(view);
    step.advance();
  });
  return views;
}

ViewGraph makeGraph(const std::vector<View>& views, const DepthStatistics& depths) {
  std::vector<const ViewHeader*> headers;
  for (const View& view : views) headers.push_back(&view);
  return {headers, depths.median};
}

SensorModel calibrateSensor(const std::vector<View>& views, const ViewGraph& graph,
                            const DepthStatistics& depths, const ReconstructOptions& options,
                            CalibrationReport& report, const Progress& progress) {
  const NoiseLaw guess = guessNoise(views, depths.median);
  const NoiseCalibration found = calibrateNoise(views, graph, guess, depths.median, progress);
  SensorModel sensor{options.noise_shape, options.noise.value_or(found.noise), depths.near, depths.far};
  sensor.prior_decay = options.prior_decay;
  if (options.noise_scale > 0) sensor.noise = lawThrough(options.noise_scale, depths.median, found.exponent);
  report.noise_scale = sensor.noise.at(depths.median);
  report.noise_exponent = options.noise ? -1 : found.exponent;
  report.median_depth = depths.median;
  return sensor;
}

Judgement judgeViews(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                     const ReconstructOptions& options, CalibrationReport& report, const Progress& progress) {
  JudgeOptions judge_options = options.judge;
  judge_options.domain = options.domain;
  Judgement judgement = judge(std::move(views), sensor, graph, judge_options, progress);
  report.miss_rate = judgement.judged.miss_rate;
  report.near = judgement.judged.sensor.near, report.far = judgement.judged.sensor.far;
  report.outlier_share = judgement.model.outlier_share;
  report.point_spacing = pointSpacing(judgement.judged);
  report.confidence = confidenceDirection(judgement.model);
  if (options.outliers) {
    report.outlier_share = *options.outliers;
    const float outlier = std::clamp(static_cast<float>(*options.outliers), 1e-6f, kMaxOutlier);
    forEachView(judgement.judged.views, [outlier](JudgedView& view) {
      std::fill(view.outlier.begin(), view.outlier.end(), outlier);
    });
  }
  return judgement;
}

void useDomain(const Box& domain, Judgement& judgement) {
  judgement.domain = domain;
  widenRange(judgement.judged, domain);
}

VoxelChoice chooseVoxel(const Box& domain, const CalibrationReport& calibration,
                        const ReconstructOptions& options) {
  using From = Parameters::VoxelFrom;
  const double longest = domain.sizes().maxCoeff();
  if (options.voxel > 0) return {options.voxel, From::Voxel};
  if (options.resolution > 0) return {longest / options.resolution, From::Resolution};
  VoxelChoice choice{calibration.point_spacing, From::PointSpacing};
  if (calibration.noise_scale > choice.size) choice = {calibration.noise_scale, From::Noise};
  if (longest / kDefaultLongestSide > choice.size)
    choice = {longest / kDefaultLongestSide, From::LongestSide};
  return choice;
}

GridFrame chooseFrame(const Box& domain, const CalibrationReport& calibration,
                      const ReconstructOptions& options) {
  return {chooseVoxel(domain, calibration, options).size};
}

std::size_t countInside(const std::vector<Eigen::Vector3d>& points, const Box& box) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [&](const auto& p) { return box.contains(p); }));
}

Border chooseBorder(std::size_t inside, std::size_t sensors) {
  return 2 * inside > sensors ? Border::Solid : Border::Outside;
}

OctreeOptions octreeOptions(const GridFrame& frame, const CalibrationReport& calibration,
                            const ReconstructOptions& options) {
  constexpr double kRidgeRadius = 2.0;  // widths of the noise: where C has fallen to 2 % of its ridge
  constexpr int kLargestRadius = 8;
  OctreeOptions octree;
  octree.max_level = options.max_level;
  if (calibration.noise_scale > frame.voxel) {
    octree.ridge_radius = static_cast<int>(
        std::min<double>(kLargestRadius, std::ceil(kRidgeRadius * calibration.noise_scale / frame.voxel)));
  }
  return octree;
}

CutOptions cutOptions(const JudgedViews& judged, const Box& domain, const GridFrame& frame,
                      const CalibrationReport& calibration, const ReconstructOptions& options) {
  CutOptions cut;
  const double noise = calibration.noise_scale, scale = std::max(frame.voxel, noise);
  cut.mu = options.mu;
  const bool is_ours = options.evidence.rule == EvidenceRule::Outside;
  cut.least_cost = options.least_cost.value_or(is_ours ? kLeastCostOfNoise * noise / scale : 0.0);
  cut.lambda = options.lambda > 0 ? options.lambda : kLambdaPerVoxel / scale;
  const std::vector<Eigen::Vector3d> sensors = sensorPositions(judged);
  cut.border = options.border.value_or(chooseBorder(countInside(sensors, domain), sensors.size()));
  return cut;
}

double leastWidth(const std::vector<int>& reduction, const CalibrationReport& calibration,
                  const ReconstructOptions& options) {
  // The spacing is that of images made smaller, the window that of the images before.
  const int factor = reduction.empty() ? 1 : *std::max_element(reduction.begin(), reduction.end());
  return std::max(calibration.noise_scale, options.window_px * calibration.point_spacing / factor);
}

EvidenceOptions evidenceOptions(const JudgedViews& judged, const Box& domain,
                                const ReconstructOptions& options) {
  EvidenceOptions evidence = options.evidence;
  evidence.visibility_prior = options.visibility_prior.value_or(visibilityPriorOf(judged));
  evidence.thickness = options.thickness.value_or(kThicknessPerDiagonal * domain.diagonal().norm());
  return evidence;
}

std::vector<Eigen::Vector3d> sensorPositions(const JudgedViews& judged) {
  std::vector<Eigen::Vector3d> positions;
  for (const JudgedView& view : judged.views) positions.push_back(view.world_from_camera.translation());
  return positions;
}

void describeVertices(const ScalarGrid& support, double mu, Reconstruction& result) {
  TriangleMesh& mesh = result.mesh;
  mesh.normals = vertexNormals(mesh);
  mesh.support.assign(mesh.vertices.size(), 0.0f);
  mesh.confidence.assign(mesh.vertices.size(), 0.0f);
  parallelFor(mesh.vertices.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      mesh.support[v] = support.interpolate(support.frame().toIndex(mesh.vertices[v].cast<double>()));
      mesh.confidence[v] = 1 - std::exp(-static_cast<float>(mu) * mesh.support[v]);
    }
  });
  double all = 0, invented = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[t[1]] - mesh.vertices[t[0]],
                          b = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double area = 0.5 * a.cross(b).norm();
    all += area;
    if (std::max({mesh.support[t[0]], mesh.support[t[1]], mesh.support[t[2]]}) < kSupported) invented += area;
  }
  result.invented_area_share = all > 0 ? invented / all : 0;
}

GridReport describeGrid(const Octree& octree, const ScalarGrid& support, const Box& domain) {
  GridReport report{octree.frame.voxel,   domain, octree.cellCount(),
                    cellsByLevel(octree), 0,      support.leafCount()};
  report.active = report.cells_by_level.front();
  return report;
}

GridReport describeGrid(const ScalarGrid& field, const Box& domain) {
  const std::size_t voxels = field.leafCount() * ScalarGrid::kLeafSize;
  return {field.frame().voxel, domain, 0, {}, voxels, field.leafCount()};
}

}  // namespace vdbfuse
