// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/integrator.h"

#include <algorithm>
#include <array>
#include <mutex>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// What is copied or looked up while integrate() waits.
constexpr std::size_t kLeavesAtATime = 1024, kVerticesAtATime = 1 << 15;

TsdfVolume makeVolume(const IntegratorOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", problems.front());
  TsdfOptions tsdf = options.tsdf;
  if (tsdf.truncation == 0) tsdf.truncation = 4 * options.voxel;
  return {{options.voxel}, tsdf};
}

}  // namespace

std::vector<std::string> validate(const IntegratorOptions& options) {
  std::vector<std::string> problems;
  if (!(options.voxel > 0)) problems.emplace_back("voxel must be positive");
  if (!(options.least_weight >= 0)) problems.emplace_back("least_weight must not be negative");
  TsdfOptions tsdf = options.tsdf;
  if (tsdf.truncation == 0) tsdf.truncation = 1;
  for (std::string& problem : validate(tsdf)) problems.push_back(std::move(problem));
  return problems;
}

struct Integrator::Impl {
  Impl(TsdfVolume start, const IntegratorOptions& integrator_options)
      : options(integrator_options), volume(std::move(start)), surface(volume.frame()) {}

  const IntegratorOptions options;
  mutable std::mutex volume_mutex;  ///< guards `volume`
  TsdfVolume volume;

  std::mutex surface_mutex;  ///< guards what follows; taken before `volume_mutex`
  LiveSurface surface;
  std::vector<std::size_t> seen;  ///< of each leaf: its change that the surface has

  template <class Fuse>
  TsdfReport withInput(const View& view, const Fuse& fuse) {
    const std::vector<std::string> problems = vdbfuse::validate(view);
    if (!problems.empty()) throw InvalidArgument("view '" + view.name + "'", problems.front());
    const Image<float> weights =
        measurementWeights(view, options.noise, volume.frame().voxel, options.weights);
    const std::lock_guard lock(volume_mutex);
    return fuse(
        TsdfInput{view, view.map.depth, &weights, view.map.color.empty() ? nullptr : &view.map.color});
  }

  // Leaves that changed since the surface saw them.
  std::vector<std::size_t> changedLeaves() {
    const std::lock_guard lock(volume_mutex);
    seen.resize(volume.leafCount(), 0);
    std::vector<std::size_t> changed;
    for (std::size_t leaf = 0; leaf < seen.size(); ++leaf)
      if (volume.lastChange(leaf) != seen[leaf]) changed.push_back(leaf);
    return changed;
  }

  void copyChanges() {
    const std::vector<std::size_t> changed = changedLeaves();
    std::array<float, ScalarGrid::kLeafSize> values;
    for (std::size_t begin = 0; begin < changed.size(); begin += kLeavesAtATime) {
      const std::lock_guard lock(volume_mutex);
      for (std::size_t i = begin; i < std::min(changed.size(), begin + kLeavesAtATime); ++i) {
        volume.copyDistances(changed[i], options.least_weight, values);
        surface.set(volume.leafOriginOf(changed[i]), values);
        seen[changed[i]] = volume.lastChange(changed[i]);
      }
    }
  }

  void makeRoomForAttributes(TriangleMesh& mesh) const {
    mesh.support.resize(mesh.vertices.size());
    if (volume.options().colors == TsdfColors::Keep) mesh.colors.resize(mesh.vertices.size());
  }

  void describeVertices(std::vector<SurfaceBlock>& blocks) const {
    for (SurfaceBlock& block : blocks) makeRoomForAttributes(block.mesh);
    for (std::size_t i = 0; i < blocks.size();) {
      const std::lock_guard lock(volume_mutex);
      for (std::size_t vertices = 0; i < blocks.size() && vertices < kVerticesAtATime; ++i) {
        volume.describeVertices(blocks[i].mesh, 0, blocks[i].mesh.vertices.size());
        vertices += blocks[i].mesh.vertices.size();
      }
    }
  }

  void describeVertices(TriangleMesh& mesh) const {
    makeRoomForAttributes(mesh);
    for (std::size_t begin = 0; begin < mesh.vertices.size(); begin += kVerticesAtATime) {
      const std::lock_guard lock(volume_mutex);
      volume.describeVertices(mesh, begin, std::min(mesh.vertices.size(), begin + kVerticesAtATime));
    }
  }
};

Integrator::Integrator(const IntegratorOptions& options) : Integrator(makeVolume(options), options) {}
Integrator::Integrator(TsdfVolume volume, const IntegratorOptions& options)
    : impl_(std::make_unique<Impl>(std::move(volume), options)) {}
Integrator::~Integrator() = default;

TsdfReport Integrator::integrate(const View& view) {
  return impl_->withInput(view, [&](const TsdfInput& input) {
    const TsdfReport report = impl_->volume.integrate(input);
    if (impl_->options.carving == IntegratorOptions::Carving::On) impl_->volume.carve(input);
    return report;
  });
}

TsdfReport Integrator::remove(const View& view) {
  return impl_->withInput(view, [&](const TsdfInput& input) { return impl_->volume.remove(input); });
}

TriangleMesh Integrator::mesh() {
  const std::lock_guard lock(impl_->surface_mutex);
  impl_->copyChanges();
  TriangleMesh mesh = impl_->surface.mesh();
  mesh.normals = vertexNormals(mesh);
  impl_->describeVertices(mesh);
  return mesh;
}

std::vector<SurfaceBlock> Integrator::changedBlocks() {
  const std::lock_guard lock(impl_->surface_mutex);
  impl_->copyChanges();
  std::vector<SurfaceBlock> blocks = impl_->surface.changedBlocks();
  impl_->describeVertices(blocks);
  return blocks;
}

std::size_t Integrator::meshedLeaves() const {
  const std::lock_guard lock(impl_->surface_mutex);
  return impl_->surface.meshedLeaves();
}

std::size_t Integrator::memoryBytes() const {
  const std::lock_guard lock(impl_->volume_mutex);
  return impl_->volume.memoryBytes();
}

std::size_t Integrator::leafCount() const {
  const std::lock_guard lock(impl_->volume_mutex);
  return impl_->volume.leafCount();
}

void Integrator::write(const std::filesystem::path& path) const {
  const std::lock_guard lock(impl_->volume_mutex);
  impl_->volume.write(path);
}

}  // namespace vdbfuse
