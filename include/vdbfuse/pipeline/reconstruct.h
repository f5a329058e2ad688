// SPDX-License-Identifier: Apache-2.0
// From depth maps to a surface: the whole line in one call.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/fusion/measurement_weight.h"
#include "vdbfuse/fusion/reliability.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/octree/graph.h"
#include "vdbfuse/sensor/view_sequence.h"
#include "vdbfuse/surface/color.h"
#include "vdbfuse/surface/field.h"

namespace vdbfuse {

enum class Method {
  Visibility,  ///< ρ, σ and a global minimum cut: watertight
  Tsdf,        ///< Curless–Levoy: open where nothing was measured
};

/// How Method::Tsdf works.
struct TsdfMethod {
  /// Length; 0: max(4 voxels, 3 × noise), or, FromOutliers, what stands for the share of outliers
  /// (truncationFor()).
  double truncation = 0.0;
  enum class Truncation { Wide, FromOutliers } otherwise = Truncation::Wide;
  /// TsdfVolume::carve() with all views.
  enum class Carving { Off, On } carving = Carving::Off;
  WeightOptions weights;
  double least_weight = 0.0;  ///< voxels with this weight or less are unknown
  /// Goes on with this volume, and takes it over: its voxels and truncation count. Set
  /// ReconstructOptions::voxel to its voxels' size.
  std::shared_ptr<TsdfVolume> start;
  int close_gaps = 2;  ///< times that closeGaps() goes over the field
  int trim_rim = 3;    ///< rings of trimRim(); 0: the rim stays frayed
};

/// Every zero or empty value means: from the data.
struct ReconstructOptions {
  Method method = Method::Visibility;

  // The grid.
  double voxel = 0.0;  ///< edge of the finest cells, unit of the poses; halving it costs about 4 ×
  int resolution = 0;  ///< or: longest side of the domain / voxel. 0 and voxel 0: the data's own resolution
  std::optional<Box> domain;  ///< world box; default: where reliable pixels of several views agree
  int max_level = 6;          ///< coarsest cells are 2^max_level voxels wide
  /// What lies beyond the domain; default: solid when most sensors are inside it, else outside.
  std::optional<Border> border;

  // The sensor.
  NoiseShape noise_shape = gaussianNoise();
  std::optional<NoiseLaw> noise;  ///< of a known sensor; default: from overlapping views
  double noise_scale = 0.0;       ///< standard deviation at the median depth; default: from overlapping views
  std::optional<double>
      outliers;              ///< outlier share, the same for every pixel; default: judged pixel by pixel
  double prior_decay = 0.0;  ///< τ of the depth prior (SensorModel::prior_decay), length; 0: flat
  /// Side of the square of pixels that each depth comes from: solid components that hold less than a cube of
  /// that width are not believed. 0: every pixel measures a point of its own.
  int window_px = 0;
  JudgeOptions judge;

  // The energy.
  EvidenceOptions evidence;
  double mu = 2.0;  ///< ρ = max(ρ₀, e^(−μ C)); larger: thin parts hold better, mistakes cost less
  /// ρ₀ (CutOptions::least_cost); default 0.4 × median noise/max(voxel, median noise), and 0 for the rules
  /// of the literature, which have none.
  std::optional<double> least_cost;
  /// Takes the place of evidence.visibility_prior; default: 1 for 8 views or fewer, ½ for 24 or more, linear
  /// between; views that repeat others count by their weights.
  std::optional<double> visibility_prior;
  /// Takes the place of evidence.thickness; default: 0.11 × diagonal of the domain. 0: off.
  std::optional<double> thickness;
  double lambda = 0.0;  ///< weight of σ, 1/length; default 0.6/max(voxel, median noise)

  // The surface.
  double smoothing_voxels = 2.0;  ///< FieldOptions::smoothing_voxels
  CompletionOptions completion;   ///< of what nobody measured
  double trim = 0.0;  ///< cut away what fewer views than this agree on (TSDF: what weighs less); 0: all
  double min_component = 0.0;  ///< least diagonal of a component's bounding box, length; 0: keep all
  std::size_t simplify = 0;    ///< triangles to be left, about; 0: all
  TsdfMethod tsdf;             ///< of Method::Tsdf

  /// Bytes that may be used; 0: 80 % of what is free. Views that do not fit lie in a file ($TMPDIR or
  /// /var/tmp) and pass by; where the cells do not fit, the reconstruction is refused before it begins.
  std::size_t memory = 0;

  /// Keep ρ, σ, support and the signed field in the result.
  enum class Grids { Drop, Keep } grids = Grids::Drop;
};

/// Everything that is wrong with the options, one sentence each.
std::vector<std::string> validate(const ReconstructOptions& options);

/// What was found out about the sensor.
struct CalibrationReport {
  double noise_scale = 0;    ///< at the median depth
  int noise_exponent = 0;    ///< of depth: 0, 1 or 2; −1: the law was given
  double median_depth = 0;   ///< of what lies in the domain, where one was given
  double point_spacing = 0;  ///< distance of neighbouring measurements in the world
  double miss_rate = 0;
  double outlier_share = 0;
  double near = 0, far = 0;
  ConfidenceDirection confidence = ConfidenceDirection::None;
};

/// "none", "high is good", "high is bad" or "uninformative".
const char* nameOf(ConfidenceDirection direction);
/// Of CalibrationReport::noise_exponent: "constant", "linear", "quadratic", or "given" for −1.
const char* nameOfLaw(int exponent);

struct GridReport {
  double voxel = 0;
  Box domain;
  std::size_t cells = 0;
  std::vector<std::size_t> cells_by_level;
  std::size_t active = 0;  ///< finest cells, or voxels of the TSDF
  std::size_t leaves = 0;  ///< 8³ blocks of the support or TSDF grid
};

struct CutReportSummary {
  std::int64_t flow = 0;
  bool certified = false;
  std::size_t nodes = 0, arcs = 0;
  CutEnergy energy;
  double lambda = 0;
  double least_cost = 0;
  double visibility_prior = 0;  ///< EvidenceOptions::visibility_prior
  double thickness = 0;         ///< EvidenceOptions::thickness; 0: off
  Border border = Border::Outside;
  CavityReport cavities;
  SpeckReport specks;          ///< smaller than a cube of the noise, or of the window
  std::size_t unresolved = 0;  ///< SurfaceField::unresolved
  /// Energy and gap of the completed parts; nothing when they were left as the cut made them.
  std::optional<CompletionReport> completion;
};

struct MemoryReport {
  std::size_t budget = 0;     ///< bytes that might be used
  std::size_t estimated = 0;  ///< bytes at the peak, before the work began
  std::size_t window = 0;     ///< bytes of views in memory at a time; 0: all of them
};

struct Reconstruction {
  TriangleMesh mesh;  ///< with normals and support
  CalibrationReport calibration;
  GridReport grid;
  std::optional<CutReportSummary> cut;  ///< nothing for the TSDF
  double truncation = 0;                ///< of the TSDF
  double invented_area_share = 0;       ///< share of the area that no view supports, before trimming
  std::size_t components_dropped = 0;   ///< below ReconstructOptions::min_component
  double simplify_error = 0;            ///< SimplifyReport::error
  std::vector<ScalarGrid> grids;
  MemoryReport memory;
  std::vector<StepTime> steps;
  std::size_t width = 0, height = 0;  ///< of the first view
};

/// Throws InvalidArgument for unusable options or views, IoError from the views' loader, Cancelled, and Error
/// when the result would be empty. Deterministic: the same mesh for any number of threads.
Reconstruction reconstruct(const ViewSequence& views, const ReconstructOptions& options = {},
                           const Progress& progress = {});

/// Colours the mesh from the views' pictures (colorVertices()). `views`: with pictures, which reconstruct()
/// itself does not look at. The time it takes is added to the steps.
ColorReport colorReconstruction(const ViewSequence& views, Reconstruction& result,
                                const Progress& progress = {});

}  // namespace vdbfuse
