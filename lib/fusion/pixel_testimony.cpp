// SPDX-License-Identifier: Apache-2.0
#include "fusion/pixel_testimony.h"

#include <algorithm>
#include <cmath>

#include "fusion/block_kernels.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

constexpr float kAgreeSigmas = 3.0f;
constexpr float kAgreeCosine = 0.70710678f;  // 45°
constexpr int kConfirmed = 3;                // this many agreeing neighbours prove a point to be there

std::uint8_t continuityBin(float share) { return share < 0.4f ? 0 : share < 0.7f ? 1 : share < 0.9f ? 2 : 3; }

// The surface faces a sensor that it sees at less than 75°.
constexpr float kFacingCosine = 0.26f;

std::uint8_t occlusionBin(int hidden) { return hidden < 2 ? 0 : hidden == 2 ? 1 : hidden < 5 ? 2 : 3; }

std::uint8_t capped(int count, std::size_t bins) {
  return static_cast<std::uint8_t>(std::min<int>(count, static_cast<int>(bins) - 1));
}

// Looks at confirmed points, and how many of them met nothing.
struct MissCounts {
  double missed = 0, looked = 0;
};

class Hearing {
  static constexpr int kTile = 16;

 public:
  Hearing(const std::vector<View>& views, const std::vector<CompactSurface>& surfaces,
          const SensorModel& sensor, std::size_t index, const std::vector<std::size_t>& neighbours,
          const std::vector<std::vector<std::size_t>>& alternatives)
      : views_(views),
        surfaces_(surfaces),
        sensor_(sensor),
        index_(index),
        neighbours_(neighbours),
        alternatives_(alternatives) {
    for (const std::size_t other : neighbours) {
      projectors_.emplace_back(views[other].projection, views[other].world_from_camera);
      noise_.emplace_back(sensor, views[other].projection);
    }
  }

  Image<PixelTestimony> hear(MissCounts& misses) const {
    const Image<float>& depth = views_[index_].map.depth;
    Image<PixelTestimony> result(depth.width(), depth.height(), {}, depth.memory());
    for (const PixelRun& run : collectRuns()) {
      const PointBlock block(run.points);
      Inquiry inquiry = inquire(run);
      for (std::size_t k = 0; k < projectors_.size(); ++k) {
        if (projectors_[k].mightSee(block.centre, block.radius)) ask(k, block, inquiry);
      }
      for (std::size_t i = 0; i < run.pixels.size(); ++i) {
        const Answers& answers = inquiry.answers[i];
        if (answers.agreeing >= kConfirmed)
          misses.missed += answers.missed, misses.looked += answers.missed + answers.agreeing;
        result.data()[run.pixels[i]] = testimonyOf(run.pixels[i], answers);
      }
    }
    return result;
  }

 private:
  // What was answered about a pixel; at most NeighbourOptions::count each.
  struct Answers {
    std::uint16_t agreeing = 0, past = 0, missed = 0, hidden = 0;
  };

  // Pixels that are asked about together.
  struct PixelRun {
    std::vector<std::size_t> pixels;
    std::vector<Eigen::Vector3d> points;
  };

  // What neighbours need to know of the pixels of a run, and what they answer.
  struct Inquiry {
    std::vector<float> noise;              // standard deviations; PointBlock::kCapacity of them
    std::vector<Eigen::Vector3f> normals;  // zero where unknown
    std::vector<Measured> said;            // by the neighbour that is being asked
    std::vector<Answers> answers;          // by all so far
  };

  std::vector<PixelRun> collectRuns() const {
    const Image<float>& depth = views_[index_].map.depth;
    std::vector<PixelRun> runs;
    for (int y = 0; y < depth.height(); y += kTile) {
      for (int x = 0; x < depth.width(); x += kTile) {
        if (runs.empty() || runs.back().points.size() + kTile * kTile > PointBlock::kCapacity)
          runs.emplace_back();
        addTile(x, y, runs.back());
      }
    }
    if (!runs.empty() && runs.back().points.empty()) runs.pop_back();
    return runs;
  }

  Inquiry inquire(const PixelRun& run) const {
    const std::size_t count = run.pixels.size();
    Inquiry inquiry{std::vector<float>(PointBlock::kCapacity), std::vector<Eigen::Vector3f>(count),
                    std::vector<Measured>(count), std::vector<Answers>(count)};
    for (std::size_t i = 0; i < count; ++i) {
      inquiry.noise[i] = static_cast<float>(sensor_.noise.at(views_[index_].map.depth.data()[run.pixels[i]]));
      inquiry.normals[i] = surfaces_[index_].normal.data()[run.pixels[i]].unpack();
    }
    return inquiry;
  }

  // Tiles stay together in the images of the neighbours, whichever way those are turned.
  void addTile(int left, int top, PixelRun& run) const {
    const View& view = views_[index_];
    const int right = std::min(left + kTile, view.map.depth.width()),
              bottom = std::min(top + kTile, view.map.depth.height());
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        if (view.map.depth(x, y) == kInvalidDepth) continue;
        run.pixels.push_back(static_cast<std::size_t>(y * view.map.depth.width() + x));
        run.points.push_back(worldPoint(view, x, y));
      }
    }
  }

  PixelTestimony testimonyOf(std::size_t pixel, const Answers& answers) const {
    PixelTestimony testimony;
    testimony.measured = true;
    testimony.agreement = capped(answers.agreeing, PixelTestimony::kAgreements) & 7u;
    testimony.contradiction = capped(answers.past, PixelTestimony::kContradictions) & 3u;
    testimony.occlusion = occlusionBin(answers.hidden) & 3u;
    testimony.misses = capped(answers.missed, PixelTestimony::kMisses) & 7u;
    testimony.continuity = surfaces_[index_].continuity.data()[pixel] & 3u;
    return testimony;
  }

  void ask(std::size_t k, const PointBlock& block, Inquiry& inquiry) const {
    const std::size_t other = neighbours_[k];
    const BlockLook seen = look(projectors_[k], block);
    prefetch(views_[other].map.depth.data(), seen, block.size);
    answer(k, other, seen, inquiry);
    if (other < alternatives_.size()) {
      for (const std::size_t layer : alternatives_[other]) askAlternative(k, layer, seen, inquiry);
    }
    if (!views_[other].map.mask.empty()) lookPastObject(views_[other].map, seen, inquiry.said);
    for (std::size_t i = 0; i < block.size; ++i) {
      Answers& answers = inquiry.answers[i];
      switch (inquiry.said[i]) {
        case Measured::Unseen:
          break;
        case Measured::Same:
          ++answers.agreeing;
          break;
        case Measured::Further:
          ++answers.past;
          break;
        case Measured::Nothing:
          ++answers.missed;
          break;
        case Measured::Nearer:
          answers.hidden += faces(inquiry.normals[i], other, block.point(i));
      }
    }
  }

  // What view `index`, neighbour k or an alternative of it, says where it saw the points.
  void answer(std::size_t k, std::size_t index, const BlockLook& seen, Inquiry& inquiry) const {
    const BlockComparison comparison = compare(views_[index].map.depth.data(), noise_[k], kAgreeSigmas,
                                               inquiry.noise.data(), seen, inquiry.said.size());
    const PackedNormal* normals = surfaces_[index].normal.data();
    for (std::size_t i = 0; i < inquiry.said.size(); ++i) {
      inquiry.said[i] = comparison[i];
      // A surface that is turned away is another, which hides the point.
      if (comparison[i] == Measured::Same && turnsAway(inquiry.normals[i], normals[seen.pixel[i]]))
        inquiry.said[i] = Measured::Nearer;
    }
  }

  // Unknown normals do not.
  static bool turnsAway(const Eigen::Vector3f& normal, PackedNormal other) {
    if (normal.isZero() || other.isNone()) return false;
    const Eigen::Vector3f direction = other.direction();
    const float along = normal.dot(direction);
    return along < 0 || along * along < kAgreeCosine * kAgreeCosine * direction.squaredNorm();
  }

  void askAlternative(std::size_t k, std::size_t layer, const BlockLook& seen, Inquiry& inquiry) const {
    const std::vector<Measured> said = inquiry.said;
    answer(k, layer, seen, inquiry);
    for (std::size_t i = 0; i < said.size(); ++i) {
      if (inquiry.said[i] != Measured::Same) inquiry.said[i] = said[i];
    }
  }

  static void lookPastObject(const DepthMap& map, const BlockLook& seen, std::vector<Measured>& said) {
    for (std::size_t i = 0; i < said.size(); ++i) {
      const int pixel = seen.pixel[i];
      if (pixel >= 0 && isOutsideMask(map, pixel % map.depth.width(), pixel / map.depth.width()))
        said[i] = Measured::Further;
    }
  }

  // An unknown normal may face anything.
  bool faces(const Eigen::Vector3f& normal, std::size_t view, const Eigen::Vector3d& point) const {
    if (normal.isZero()) return true;
    const Eigen::Vector3f to_sensor = (views_[view].world_from_camera.translation() - point).cast<float>();
    const float along = normal.dot(to_sensor);
    return along > 0 && along * along > kFacingCosine * kFacingCosine * to_sensor.squaredNorm();
  }

  const std::vector<View>& views_;
  const std::vector<CompactSurface>& surfaces_;
  const SensorModel& sensor_;
  std::size_t index_;
  const std::vector<std::size_t>& neighbours_;
  const std::vector<std::vector<std::size_t>>& alternatives_;
  std::vector<Projector> projectors_;
  std::vector<NoiseTable> noise_;
};

}  // namespace

CompactSurface compact(const PixelSurface& surface, std::pmr::memory_resource* memory) {
  const int width = surface.normal.width(), height = surface.normal.height();
  CompactSurface result{Image<PackedNormal>(width, height, {}, memory),
                        Image<std::uint8_t>(width, height, 0, memory),
                        Image<float>(surface.incidence, memory)};
  std::transform(surface.normal.begin(), surface.normal.end(), result.normal.begin(),
                 [](const Eigen::Vector3f& normal) { return PackedNormal(normal); });
  std::transform(surface.continuity.begin(), surface.continuity.end(), result.continuity.begin(),
                 continuityBin);
  return result;
}

void letGo(const CompactSurface& surface) {
  letGo(surface.normal), letGo(surface.continuity), letGo(surface.incidence);
}

Testimonies hearNeighbours(const std::vector<View>& views, const std::vector<CompactSurface>& surfaces,
                           const SensorModel& sensor, const std::vector<std::vector<std::size_t>>& neighbours,
                           const std::vector<std::vector<std::size_t>>& alternatives,
                           const std::vector<std::size_t>& order, const Progress& progress) {
  Testimonies result;
  result.views.resize(views.size());
  std::vector<MissCounts> misses(views.size());
  ProgressStep step(progress, "judge pixels", views.size());
  Neighbourhoods hearings{order, neighbours, windowBytes(views.front().memory()), {}, {}};
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const std::size_t other : neighbours[i]) {
      if (other >= alternatives.size()) continue;
      const std::vector<std::size_t>& layers = alternatives[other];
      hearings.needed[i].insert(hearings.needed[i].end(), layers.begin(), layers.end());
    }
  }
  hearings.bytes = [&](std::size_t i) {
    return imageBytes(views[i]) + views[i].map.depth.size() * (sizeof(PackedNormal) + sizeof(PixelTestimony));
  };
  hearings.let_go = [&](std::size_t i) { letGo(views[i]), letGo(surfaces[i]), letGo(result.views[i]); };
  forEachNeighbourhood(hearings, [&](std::size_t i) {
    result.views[i] = Hearing(views, surfaces, sensor, i, neighbours[i], alternatives).hear(misses[i]);
    step.advance();
  });
  MissCounts sum;
  for (const MissCounts& m : misses) sum.missed += m.missed, sum.looked += m.looked;
  if (sum.looked > 0) result.miss_rate = sum.missed / sum.looked;
  return result;
}

}  // namespace vdbfuse
