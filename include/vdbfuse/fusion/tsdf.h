// SPDX-License-Identifier: Apache-2.0
// Curless & Levoy, "A volumetric method for building complex models from range images", SIGGRAPH 1996: a
// running weighted mean of truncated signed distances, a view at a time.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/sensor/judged_view.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

enum class TsdfStorage {
  Single,  ///< distance and weight as floats: 8 bytes a voxel
  Half,    ///< 16 bits each: 4 bytes; distances to truncation/32767, weights stop at 511
};

enum class TsdfColors {
  None,
  Keep,  ///< a mean colour near the surface: 8 bytes a voxel more
};

struct TsdfOptions {
  /// Distances beyond ±truncation are not believed; length, > 0. A few voxels, and a few widths of the noise:
  /// smaller keeps thin parts apart, larger survives noise and errors of the poses. See truncationFor().
  double truncation = 0.0;
  std::optional<Box> domain;  ///< leaves that do not meet it are not made
  TsdfStorage storage = TsdfStorage::Single;
  TsdfColors colors = TsdfColors::None;
};

/// Everything that is wrong with the options, one sentence each.
std::vector<std::string> validate(const TsdfOptions& options);

/// The truncation that stands for an outlier share ε: T = w log((2 − ε)/ε), where the log-odds of a
/// measurement with logistic noise of standard deviation `noise_scale` level off (w = √3/π of it). Throws
/// InvalidArgument unless 0 < ε < 1.
double truncationFor(double noise_scale, double outlier_share);

/// A depth map as it is integrated. Nothing of it is kept.
struct TsdfInput {
  const ViewHeader& view;
  const Image<float>& depth;             ///< at least 2×2 pixels
  const Image<float>* weight = nullptr;  ///< of depth's size, ≥ 0, 0: do not use; null: 1 everywhere
  const Image<Rgb8>* color = nullptr;    ///< of any size; null: none
};

struct TsdfReport {
  std::size_t leaves = 0;   ///< that the view changed
  std::size_t created = 0;  ///< of them, new ones
  std::size_t voxels = 0;   ///< that lie within the truncation of a measurement
  std::size_t before = 0;   ///< that lie further before one, and count as outside
};

/// Voxels near measurements, in OpenVDB leaves of 8³. A voxel whose nearest pixel lies within ±truncation of
/// it takes the depth D between the four pixels around its projection, or that of the nearest one where they
/// do not belong to one surface; D − d goes into its mean with the pixel's weight. In the leaves where there
/// are such voxels those up to 1.5 truncations before the measurement count as one before it,
/// so that a surface seen under a grazing angle has known voxels on both sides. Weights are rounded to 1/64
/// (and are at least that, unless 0): sums of weights are exact, so that a view can be taken out again. Not
/// for several threads at once; uses several itself. The same for any number of threads.
class TsdfVolume {
 public:
  /// Throws InvalidArgument.
  TsdfVolume(const GridFrame& frame, const TsdfOptions& options);
  ~TsdfVolume();
  TsdfVolume(TsdfVolume&&) noexcept;
  TsdfVolume& operator=(TsdfVolume&&) noexcept;

  /// Throws InvalidArgument when images and projection do not fit.
  TsdfReport integrate(const TsdfInput& input);
  /// Takes a view out that was integrated with the same input. Voxels that no other view saw become unknown.
  /// Throws InvalidArgument once the volume was carved: what a view did then depends on what came before it.
  TsdfReport remove(const TsdfInput& input);
  /// What a view says of voxels further before its measurement than those that integrate() counts: that they
  /// are outside. Only voxels that are known already, so that nothing appears that was not measured; and only
  /// by pixels that two of the four beside them agree with, since single wrong depths would carve through
  /// everything. For a set of views: integrate all, then carve with all.
  TsdfReport carve(const TsdfInput& input);

  /// Lets leaves be made there, too.
  void growDomain(const Box& domain);

  const GridFrame& frame() const;
  const TsdfOptions& options() const;
  std::size_t leafCount() const;
  std::size_t memoryBytes() const;  ///< of the trees

  /// Distance > 0 outside, kUnknown where the weight is `least_weight` or less; the sum of the weights.
  ScalarGrid distance(float least_weight = 0.0f) const;
  ScalarGrid weight() const;

  /// Leaves in the order in which they were made: a leaf keeps its number.
  Index3 leafOriginOf(std::size_t leaf) const;
  void copyDistances(std::size_t leaf, float least_weight, std::span<float, ScalarGrid::kLeafSize> out) const;
  /// The number of calls of integrate(), remove() and carve() up to the last that changed a leaf.
  std::size_t lastChange(std::size_t leaf) const;
  std::size_t changes() const;  ///< calls of these

  /// Gives the mesh's vertices the weight around them as support, and their colours when there are any.
  void describeVertices(TriangleMesh& mesh) const;
  /// Only vertices [begin, end). REQUIRES: mesh.support, and with colours mesh.colors, have their size.
  void describeVertices(TriangleMesh& mesh, std::size_t begin, std::size_t end) const;

  /// `surface`, `weight`, and with colours `red`, `green`, `blue` and `color_weight`: for other tools, and,
  /// with what read() needs to know in the metadata of `surface`, to go on with.
  std::vector<ScalarGrid> grids() const;
  /// These grids as a file. Throws IoError; an existing file survives.
  void write(const std::filesystem::path& path) const;
  /// A volume that goes on as if it had never been written. Throws IoError.
  static TsdfVolume read(const std::filesystem::path& path);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Σ_i (D_i − d_i)/s_i at each point, not truncated, not normalised: what (11) says the evidence is for
/// logistic noise, no outliers, a flat depth prior and no self-occlusion. s_i is the scale of lookupNoise().
std::vector<double> untruncatedSum(const JudgedViews& judged, const std::vector<Eigen::Vector3d>& points);

}  // namespace vdbfuse
