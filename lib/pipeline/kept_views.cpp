// SPDX-License-Identifier: Apache-2.0
#include "pipeline/kept_views.h"

#include "vdbfuse/base/scratch_memory.h"

namespace vdbfuse {
namespace {

// Of views that one after the other goes through: pages leave as soon as a view is packed or unpacked.
constexpr std::size_t kWindowBytes = 0;

bool isFar(const RigidTransform& last, const RigidTransform& pose, const KeyViews& key_views) {
  const Eigen::AngleAxisd turn(last.linear().transpose() * pose.linear());
  return (pose.translation() - last.translation()).norm() > key_views.distance ||
         turn.angle() > key_views.angle;
}

}  // namespace

void moveTo(const RigidTransform& world_from_camera, ViewHeader& header) {
  if (header.color_sensor) {
    RigidTransform& color = header.color_sensor->world_from_camera;
    color = world_from_camera * (header.world_from_camera.inverse() * color);
  }
  header.world_from_camera = world_from_camera;
}

std::shared_ptr<std::pmr::memory_resource> KeptViews::nextMemory() {
  if (bytes_ < memory_limit_) return {std::shared_ptr<void>(), std::pmr::new_delete_resource()};
  if (!file_) file_ = std::make_shared<ScratchMemory>(kWindowBytes);
  return file_;
}

void KeptViews::insert(ViewId id, KeptView view) {
  bytes_ += view.images->bytes();
  views_.emplace(id, std::move(view));
}

void KeptViews::erase(ViewId id) {
  const auto found = views_.find(id);
  bytes_ -= found->second.images->bytes();
  views_.erase(found);
}

const KeptView* KeptViews::find(ViewId id) const {
  const auto found = views_.find(id);
  return found == views_.end() ? nullptr : &found->second;
}

ViewSequence KeptViews::sequence(const KeyViews& key_views) const {
  const bool every = key_views.distance == 0 && key_views.angle == 0;
  std::vector<ViewHeader> headers;
  auto images = std::make_shared<std::vector<std::shared_ptr<const PackedImages>>>();
  for (const auto& entry : views_) {
    const KeptView& view = entry.second;
    if (!every && !headers.empty() &&
        !isFar(headers.back().world_from_camera, view.header.world_from_camera, key_views))
      continue;
    headers.push_back(view.header);
    images->push_back(view.images);
  }
  return {std::move(headers), [images](std::size_t index) { return (*images)[index]->unpack(); }};
}

}  // namespace vdbfuse
