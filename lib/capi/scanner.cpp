// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "capi/handles.h"
#include "vdbfuse/base/parallel.h"

using namespace vdbfuse;
using namespace vdbfuse::capi;

namespace {

// Bytes of the structs in version 1 of the interface.
constexpr std::size_t kOptionsBytes = offsetof(vdbfuse_scanner_options, colors) + sizeof(std::int32_t),
                      kStatusBytes = offsetof(vdbfuse_scanner_status, kept_bytes) + sizeof(std::uint64_t);

vdbfuse_scanner_options defaultScanner() {
  const ScannerOptions from;
  vdbfuse_scanner_options options{};
  options.struct_size = sizeof options;
  options.near_depth = from.near, options.far_depth = from.far;
  options.queue_capacity = from.queue_capacity, options.memory_bytes = from.memory;
  options.when_full = VDBFUSE_DROP_OLDEST;
  return options;
}

ScannerOptions scannerOptionsOf(const vdbfuse_scanner_options* given) {
  const vdbfuse_scanner_options from = readStruct(given, defaultScanner(), kOptionsBytes, "options");
  ScannerOptions options;
  options.preview.voxel = from.voxel;
  options.preview.tsdf.truncation = from.truncation;
  options.preview.tsdf.colors = from.colors != 0 ? TsdfColors::Keep : TsdfColors::None;
  if (from.sensor != nullptr) options.preview.noise = sensorPreset(from.sensor).noise;
  options.near = from.near_depth, options.far = from.far_depth;
  options.queue_capacity = static_cast<std::size_t>(from.queue_capacity);
  options.memory = static_cast<std::size_t>(from.memory_bytes);
  options.when_full = choice(from.when_full, {WhenFull::DropOldest, WhenFull::DropNewest, WhenFull::Wait},
                             "options.when_full");
  return options;
}

// Calls use(scanner).
template <class Use>
vdbfuse_status with(vdbfuse_scanner* scanner, const Use& use) noexcept {
  return guarded([&] {
    requireNotNull(scanner, "scanner");
    use(scanner->scanner);
  });
}

vdbfuse_preview* handleOf(ScannerPreview preview) {
  auto handle = std::make_unique<vdbfuse_preview>();
  for (SurfaceBlock& block : preview.changed) {
    handle->changed_origins.push_back(block.origin);
    handle->changed.push_back({std::move(block.mesh)});
  }
  handle->removed_origins = std::move(preview.removed);
  handle->newest = preview.newest;
  return handle.release();
}

}  // namespace

vdbfuse_status vdbfuse_scanner_options_init(vdbfuse_scanner_options* options, uint64_t struct_size) {
  return guarded([&] { writeStruct(defaultScanner(), struct_size, kOptionsBytes, "options", options); });
}

vdbfuse_status vdbfuse_scanner_create(const vdbfuse_scanner_options* options, vdbfuse_scanner** out) {
  return guardedHandle(out, [&] { return new vdbfuse_scanner{Scanner(scannerOptionsOf(options))}; });
}

vdbfuse_status vdbfuse_scanner_push(vdbfuse_scanner* scanner, const vdbfuse_view* view, uint64_t* id) {
  if (id != nullptr) *id = 0;
  return with(scanner, [&](Scanner& target) {
    const ViewId given = target.push(viewOf(view)).value_or(0);
    if (id != nullptr) *id = given;
  });
}

vdbfuse_status vdbfuse_scanner_remove(vdbfuse_scanner* scanner, uint64_t id) {
  return with(scanner, [&](Scanner& target) { target.remove(id); });
}

vdbfuse_status vdbfuse_scanner_correct_poses(vdbfuse_scanner* scanner, size_t count, const uint64_t* ids,
                                             const double* world_from_camera) {
  return with(scanner, [&](Scanner& target) {
    if (count == 0) return;
    requireNotNull(ids, "ids");
    requireNotNull(world_from_camera, "world_from_camera");
    std::vector<PoseCorrection> corrections;
    for (std::size_t i = 0; i < count; ++i)
      corrections.push_back({ids[i], poseOf(world_from_camera + 16 * i)});
    target.correctPoses(corrections);
  });
}

vdbfuse_status vdbfuse_scanner_wait(vdbfuse_scanner* scanner) {
  return with(scanner, [](Scanner& target) { target.wait(); });
}

vdbfuse_status vdbfuse_scanner_get_status(const vdbfuse_scanner* scanner, vdbfuse_scanner_status* out) {
  return guarded([&] {
    requireNotNull(scanner, "scanner");
    requireNotNull(out, "status");
    const ScannerStatus status = scanner->scanner.status();
    writeStruct({0, status.pushed, status.integrated, status.dropped, status.waiting, status.corrections,
                 status.kept, status.kept_bytes},
                out->struct_size, kStatusBytes, "status", out);
  });
}

vdbfuse_status vdbfuse_scanner_mesh(vdbfuse_scanner* scanner, vdbfuse_mesh** out) {
  return guardedHandle(out, [&] {
    requireNotNull(scanner, "scanner");
    return new vdbfuse_mesh{scanner->scanner.mesh()};
  });
}

vdbfuse_status vdbfuse_scanner_finish(vdbfuse_scanner* scanner, const vdbfuse_fuse_options* options,
                                      vdbfuse_mesh** out) {
  return guardedHandle(out, [&] {
    requireNotNull(scanner, "scanner");
    const FuseRequest request = fuseRequestOf(options);
    const ThreadLimit threads(request.threads);
    return new vdbfuse_mesh{scanner->scanner.finish(request.finish, Progress(request.callback())).mesh};
  });
}

void vdbfuse_scanner_destroy(vdbfuse_scanner* scanner) { delete scanner; }

vdbfuse_status vdbfuse_scanner_preview(vdbfuse_scanner* scanner, vdbfuse_preview** out) {
  return guardedHandle(out, [&] {
    requireNotNull(scanner, "scanner");
    return handleOf(scanner->scanner.preview());
  });
}

uint64_t vdbfuse_preview_newest(const vdbfuse_preview* preview) {
  return preview == nullptr ? 0 : preview->newest;
}

size_t vdbfuse_preview_changed_count(const vdbfuse_preview* preview) {
  return preview == nullptr ? 0 : preview->changed.size();
}

const vdbfuse_mesh* vdbfuse_preview_changed(const vdbfuse_preview* preview, size_t index, int32_t* origin) {
  if (preview == nullptr || index >= preview->changed.size()) return nullptr;
  for (int a = 0; origin != nullptr && a < 3; ++a) origin[a] = preview->changed_origins[index][a];
  return &preview->changed[index];
}

size_t vdbfuse_preview_removed_count(const vdbfuse_preview* preview) {
  return preview == nullptr ? 0 : preview->removed_origins.size();
}

const int32_t* vdbfuse_preview_removed(const vdbfuse_preview* preview) {
  return preview == nullptr || preview->removed_origins.empty() ? nullptr
                                                                : preview->removed_origins.front().data();
}

void vdbfuse_preview_destroy(vdbfuse_preview* preview) { delete preview; }
