// SPDX-License-Identifier: Apache-2.0
#include "fusion/missed_surfaces.h"

#include <Eigen/Core>
#include <utility>

#include "fusion/block_kernels.h"

namespace vdbfuse {
namespace {

constexpr int kStep = 2;
constexpr float kReliable = 0.2f;

class MissedSurfaces {
 public:
  MissedSurfaces(const JudgedView& view, const Box& domain)
      : view_(view),
        domain_(domain),
        projector_(view.projection, view.world_from_camera),
        missed_(view.depth.width(), view.depth.height()) {}

  void lookFor(const JudgedView& other) {
    const Image<float>& depth = other.depth;
    for (int y = 0; y < depth.height(); y += kStep) {
      for (int x = 0; x < depth.width(); x += kStep) {
        if (depth(x, y) == kInvalidDepth || other.outlier(x, y) >= kReliable) continue;
        const Eigen::Vector3d point =
            other.world_from_camera * unproject(other.projection, x, y, depth(x, y));
        if (domain_.contains(point)) points_.push_back(point);
        if (points_.size() == PointBlock::kCapacity) lookUp();
      }
    }
    if (!points_.empty()) lookUp();
  }

  Image<std::uint8_t> take() { return std::move(missed_); }

 private:
  void lookUp() {
    const PointBlock block(points_);
    if (projector_.mightSee(block.centre, block.radius)) {
      const BlockLook seen = look(projector_, block);
      for (std::size_t i = 0; i < block.size; ++i) {
        const int pixel = seen.pixel[i];
        if (pixel < 0) continue;
        const auto p = static_cast<std::size_t>(pixel);
        missed_.data()[p] |= view_.depth.data()[p] == kInvalidDepth;
      }
    }
    points_.clear();
  }

  const JudgedView& view_;
  const Box& domain_;
  Projector projector_;
  std::vector<Eigen::Vector3d> points_;
  Image<std::uint8_t> missed_;
};

}  // namespace

Image<std::uint8_t> missedSurfaces(const std::vector<JudgedView>& views, std::size_t index,
                                   const std::vector<std::size_t>& neighbours, const Box& domain) {
  MissedSurfaces missed(views[index], domain);
  for (const std::size_t other : neighbours) missed.lookFor(views[other]);
  return missed.take();
}

}  // namespace vdbfuse
