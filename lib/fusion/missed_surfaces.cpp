// SPDX-License-Identifier: Apache-2.0
#include "fusion/missed_surfaces.h"

#include <Eigen/Core>
#include <utility>

#include "fusion/block_kernels.h"

namespace vdbfuse {
namespace {

class MissedSurfaces {
 public:
  MissedSurfaces(const JudgedView& view, const Box& domain)
      : view_(view),
        domain_(domain),
        projector_(view.projection, view.world_from_camera),
        result_(view.depth.width(), view.depth.height()) {}

  void lookFor(const JudgedView& other, const PixelList& missed) {
    const Unprojector unprojector(other.projection, other.world_from_camera);
    const auto width = static_cast<std::uint32_t>(other.depth.width());
    for (const std::uint32_t p : missed) {
      const Eigen::Vector3d point = unprojector(p % width, p / width, other.depth.data()[p]);
      if (domain_.contains(point)) points_.push_back(point);
      if (points_.size() == PointBlock::kCapacity) lookUp();
    }
    if (!points_.empty()) lookUp();
  }

  Image<std::uint8_t> take() { return std::move(result_); }

 private:
  void lookUp() {
    const PointBlock block(points_);
    if (projector_.mightSee(block.centre, block.radius)) {
      const BlockLook seen = look(projector_, block);
      for (std::size_t i = 0; i < block.size; ++i) {
        const int pixel = seen.pixel[i];
        if (pixel < 0) continue;
        const auto p = static_cast<std::size_t>(pixel);
        result_.data()[p] |= view_.depth.data()[p] == kInvalidDepth;
      }
    }
    points_.clear();
  }

  const JudgedView& view_;
  const Box& domain_;
  Projector projector_;
  std::vector<Eigen::Vector3d> points_;
  Image<std::uint8_t> result_;
};

}  // namespace

PixelList missedPixels(const JudgedView& view, const Image<PixelTestimony>& testimony) {
  constexpr int kStep = 2;
  constexpr float kReliable = 0.2f;
  PixelList missed;
  for (int y = 0; y < testimony.height(); y += kStep) {
    for (int x = 0; x < testimony.width(); x += kStep) {
      if (testimony(x, y).misses > 0 && view.outlier(x, y) < kReliable)
        missed.push_back(static_cast<std::uint32_t>(y * testimony.width() + x));
    }
  }
  return missed;
}

Image<std::uint8_t> missedSurfaces(const std::vector<JudgedView>& views, std::size_t index,
                                   const std::vector<std::size_t>& neighbours,
                                   const std::vector<PixelList>& missed, const Box& domain) {
  MissedSurfaces surfaces(views[index], domain);
  for (const std::size_t other : neighbours) surfaces.lookFor(views[other], missed[other]);
  return surfaces.take();
}

}  // namespace vdbfuse
