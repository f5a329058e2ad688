// SPDX-License-Identifier: Apache-2.0
// Depth maps as they come from a sensor, into a surface that can be looked at all the while.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/fusion/measurement_weight.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/surface/live_surface.h"

namespace vdbfuse {

struct IntegratorOptions {
  double voxel = 0.0;  ///< unit of the poses, > 0. Half the size: 4 × the memory, 3 to 4 × the time
  /// truncation 0: 4 voxels.
  TsdfOptions tsdf;
  WeightOptions weights;
  /// On: each view carves what was integrated before it (TsdfVolume::carve()); less than twice the time.
  enum class Carving { Off, On } carving = Carving::Off;
  /// Of the sensor's depth (sensorPreset()); without one, near and far count the same.
  std::optional<NoiseLaw> noise;
  /// Voxels with this weight or less are unknown to mesh(). A view counts 1 where it sees a surface from the
  /// front.
  float least_weight = 0.0f;
};

/// Everything that is wrong with the options, one sentence each.
std::vector<std::string> validate(const IntegratorOptions& options);

/// One thread integrates, another may ask for the mesh meanwhile: it is made of what has been integrated when
/// it is asked for, perhaps with parts of the views that come while it is made, and holds integrate() up for
/// a thousand leaves at a time only. Triangles are made anew only where something changed since the last
/// mesh; putting all of them together, normals and colours are a pass over the whole.
class Integrator {
 public:
  /// Throws InvalidArgument.
  explicit Integrator(const IntegratorOptions& options);
  /// Goes on with a volume, with its voxels and TSDF options; `options.voxel` and `options.tsdf` are not
  /// looked at.
  Integrator(TsdfVolume volume, const IntegratorOptions& options);
  ~Integrator();

  /// Takes the depths, confidences and colours of a view in. Throws InvalidArgument when validate(view)
  /// objects.
  TsdfReport integrate(const View& view);
  /// Takes out a view that was taken in; see TsdfVolume::remove().
  TsdfReport remove(const View& view);

  /// The surface with normals, the weights as support, and colours if they are kept: an open rim where space
  /// is unknown.
  TriangleMesh mesh();
  /// What changed of it since the last call, with support and colours in the same way: LiveSurface's blocks.
  /// The cost is that of the changes.
  std::vector<SurfaceBlock> changedBlocks();
  /// Leaves that the last call of mesh() or changedBlocks() worked on.
  std::size_t meshedLeaves() const;
  /// Of the volume; that of mesh() beside it is half as much again.
  std::size_t memoryBytes() const;
  std::size_t leafCount() const;

  /// See TsdfVolume::write().
  void write(const std::filesystem::path& path) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
