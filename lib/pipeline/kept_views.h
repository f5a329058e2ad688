// SPDX-License-Identifier: Apache-2.0
// The views of a live scan after they were worked in: for the cut at the end, and to take them out again.
#pragma once

#include <map>
#include <memory>
#include <memory_resource>

#include "pipeline/packed_images.h"
#include "vdbfuse/pipeline/scanner.h"

namespace vdbfuse {

struct KeptView {
  ViewHeader header;  ///< at the pose at which the view was integrated
  std::shared_ptr<const PackedImages> images;

  View unpack() const { return {header, images->unpack()}; }
};

/// The sensor, and the camera of its pictures, moved so that the sensor is at `world_from_camera`.
void moveTo(const RigidTransform& world_from_camera, ViewHeader& header);

/// Not for several threads at once.
class KeptViews {
 public:
  /// `memory`: bytes beyond which views lie in a file.
  explicit KeptViews(std::size_t memory) : memory_limit_(memory) {}

  /// Where the next view belongs. Throws IoError when no file can be made.
  std::shared_ptr<std::pmr::memory_resource> nextMemory();
  void insert(ViewId id, KeptView view);
  void erase(ViewId id);
  const KeptView* find(ViewId id) const;
  KeptView& at(ViewId id) { return views_.at(id); }

  std::size_t size() const { return views_.size(); }
  std::size_t bytes() const { return bytes_; }
  /// Those that are enough, in the order of their numbers. Outlives this object.
  ViewSequence sequence(const KeyViews& key_views) const;

 private:
  std::size_t memory_limit_;
  std::size_t bytes_ = 0;
  std::shared_ptr<std::pmr::memory_resource> file_;  ///< once it is needed
  std::map<ViewId, KeptView> views_;
};

}  // namespace vdbfuse
