// SPDX-License-Identifier: Apache-2.0
#include "fusion/pixel_testimony.h"

#include <algorithm>
#include <cmath>

#include "fusion/prepared_view.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {
namespace {

constexpr double kAgreeSigmas = 3.0;
constexpr double kAgreeCosine = 0.70710678;  // 45°
constexpr int kConfirmed = 3;                // this many agreeing neighbours prove a point to be there

std::uint8_t continuityBin(float share) { return share < 0.4f ? 0 : share < 0.7f ? 1 : share < 0.9f ? 2 : 3; }

// The surface faces a sensor that it sees at less than 75°.
constexpr float kFacingCosine = 0.26f;

std::uint8_t occlusionBin(int hidden) { return hidden < 2 ? 0 : hidden == 2 ? 1 : hidden < 5 ? 2 : 3; }

enum class Answer { Unseen, Agrees, SeesPast, Missed, Hidden };

std::uint8_t capped(int count, std::size_t bins) {
  return static_cast<std::uint8_t>(std::min<int>(count, static_cast<int>(bins) - 1));
}

// Looks at confirmed points, and how many of them met nothing.
struct MissCounts {
  double missed = 0, looked = 0;
};

class Hearing {
 public:
  Hearing(const std::vector<View>& views, const std::vector<PixelSurface>& surfaces,
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
    Image<PixelTestimony> result(depth.width(), depth.height());
    for (int y = 0; y < depth.height(); ++y) {
      for (int x = 0; x < depth.width(); ++x) {
        if (depth(x, y) != kInvalidDepth) result(x, y) = hearPixel(x, y, misses);
      }
    }
    return result;
  }

 private:
  PixelTestimony hearPixel(int x, int y, MissCounts& misses) const {
    const Eigen::Vector3d point = worldPoint(views_[index_], x, y);
    const double noise = sensor_.noise.at(views_[index_].map.depth(x, y));
    const Eigen::Vector3f normal = surfaces_[index_].normal(x, y);
    int agreeing = 0, past = 0, missed = 0, hidden = 0;
    for (std::size_t k = 0; k < projectors_.size(); ++k) {
      const Answer answer = ask(k, point, noise, normal);
      agreeing += answer == Answer::Agrees;
      past += answer == Answer::SeesPast;
      missed += answer == Answer::Missed;
      hidden += answer == Answer::Hidden && faces(normal, neighbours_[k], point);
    }
    if (agreeing >= kConfirmed) misses.missed += missed, misses.looked += missed + agreeing;
    PixelTestimony testimony;
    testimony.measured = true;
    testimony.agreement = capped(agreeing, PixelTestimony::kAgreements);
    testimony.contradiction = capped(past, PixelTestimony::kContradictions);
    testimony.occlusion = occlusionBin(hidden);
    testimony.misses = capped(missed, PixelTestimony::kMisses);
    testimony.continuity = continuityBin(surfaces_[index_].continuity(x, y));
    return testimony;
  }

  // An unknown normal may face anything.
  bool faces(const Eigen::Vector3f& normal, std::size_t view, const Eigen::Vector3d& point) const {
    const Eigen::Vector3f to_sensor =
        (views_[view].world_from_camera.translation() - point).cast<float>().normalized();
    return normal.isZero() || normal.dot(to_sensor) > kFacingCosine;
  }

  Answer ask(std::size_t k, const Eigen::Vector3d& point, double noise, const Eigen::Vector3f& normal) const {
    const std::optional<Sighting> seen = projectors_[k](point);
    if (!seen) return Answer::Unseen;
    if (isOutsideMask(views_[neighbours_[k]].map, seen->x, seen->y)) return Answer::SeesPast;
    const Answer answer = compare(k, neighbours_[k], *seen, noise, normal);
    if (answer == Answer::Agrees || neighbours_[k] >= alternatives_.size()) return answer;
    for (const std::size_t layer : alternatives_[neighbours_[k]]) {
      if (compare(k, layer, *seen, noise, normal) == Answer::Agrees) return Answer::Agrees;
    }
    return answer;
  }

  // What view `index`, neighbour k or an alternative of it, measured where it saw the point.
  Answer compare(std::size_t k, std::size_t index, const Sighting& seen, double noise,
                 const Eigen::Vector3f& normal) const {
    const View& other = views_[index];
    const float measured = other.map.depth(seen.x, seen.y);
    if (measured == kInvalidDepth) return Answer::Missed;
    const double further = measured - seen.depth, other_noise = noise_[k].at(measured);
    if (further * further > kAgreeSigmas * kAgreeSigmas * (noise * noise + other_noise * other_noise))
      return further > 0 ? Answer::SeesPast : Answer::Hidden;
    const Eigen::Vector3f other_normal = surfaces_[index].normal(seen.x, seen.y);
    if (normal.isZero() || other_normal.isZero()) return Answer::Agrees;
    return normal.dot(other_normal) >= kAgreeCosine ? Answer::Agrees : Answer::Hidden;
  }

  const std::vector<View>& views_;
  const std::vector<PixelSurface>& surfaces_;
  const SensorModel& sensor_;
  std::size_t index_;
  const std::vector<std::size_t>& neighbours_;
  const std::vector<std::vector<std::size_t>>& alternatives_;
  std::vector<Projector> projectors_;
  std::vector<NoiseTable> noise_;
};

}  // namespace

Testimonies hearNeighbours(const std::vector<View>& views, const std::vector<PixelSurface>& surfaces,
                           const SensorModel& sensor, const std::vector<std::vector<std::size_t>>& neighbours,
                           const std::vector<std::vector<std::size_t>>& alternatives,
                           const Progress& progress) {
  Testimonies result;
  result.views.resize(views.size());
  std::vector<MissCounts> misses(views.size());
  ProgressStep step(progress, "judge pixels", views.size());
  parallelFor(views.size(), 1, [&](std::size_t i, std::size_t) {
    result.views[i] = Hearing(views, surfaces, sensor, i, neighbours[i], alternatives).hear(misses[i]);
    step.advance();
  });
  MissCounts sum;
  for (const MissCounts& m : misses) sum.missed += m.missed, sum.looked += m.looked;
  if (sum.looked > 0) result.miss_rate = sum.missed / sum.looked;
  return result;
}

}  // namespace vdbfuse
