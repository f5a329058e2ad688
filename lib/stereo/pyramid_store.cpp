// SPDX-License-Identifier: Apache-2.0
#include "stereo/pyramid_store.h"

#include <algorithm>

#include "stereo/match_view.h"

namespace vdbfuse::stereo {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

std::size_t bytesOf(const Pyramid& pyramid) {
  std::size_t bytes = 0;
  for (const PictureLevel& level : pyramid)
    bytes += level.value.size() * 2 + level.quads.size() * 8 + level.mask.size();
  return bytes;
}

}  // namespace

PyramidStore::PyramidStore(const PhotographSequence& photographs, const StereoOptions& options)
    : photographs_(photographs) {
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    const Pinhole& camera = photographs.header(i).camera;
    levels_ = std::max(levels_, levelsFor(camera.width, camera.height, options));
  }
}

std::shared_ptr<const Pyramid> PyramidStore::get(std::size_t index) {
  recent_.remove(index);
  recent_.push_front(index);
  if (const auto found = kept_.find(index); found != kept_.end()) return found->second;
  auto pyramid = std::make_shared<const Pyramid>(picturePyramid(photographs_.load(index), levels_));
  bytes_ += bytesOf(*pyramid);
  kept_[index] = pyramid;
  while (bytes_ > kMostBytes && recent_.size() > 1) {
    const auto oldest = kept_.find(recent_.back());
    bytes_ -= bytesOf(*oldest->second);
    kept_.erase(oldest);
    recent_.pop_back();
  }
  return pyramid;
}

}  // namespace vdbfuse::stereo
