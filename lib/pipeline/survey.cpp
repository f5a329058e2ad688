// SPDX-License-Identifier: Apache-2.0
#include "pipeline/survey.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "pipeline/steps.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/point_spacing.h"
#include "vdbfuse/sensor/reduce.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kViews = 32;
constexpr double kPixelsPerView = 20000;
constexpr float kDoubtful = 0.45f;

struct SmallViews {
  std::vector<View> views;
  double factor = 1;  // of their images, the smallest
};

SmallViews loadSmall(const ViewSequence& sequence, const Progress& progress) {
  const std::size_t count = std::min(kViews, sequence.size());
  SmallViews small;
  small.views.resize(count);
  std::vector<int> factors(count);
  ProgressStep step(progress, "look at views", count);
  parallelFor(count, 1, [&](std::size_t i, std::size_t) {
    View view = sequence.load(i * sequence.size() / count);
    const auto pixels = static_cast<double>(view.map.depth.size());
    factors[i] = std::max(1, static_cast<int>(std::sqrt(pixels / kPixelsPerView)));
    view.map.color = {}, view.map.alternatives.clear();
    small.views[i] = reduced(std::move(view), factors[i], Reduction::Pick);
    step.advance();
  });
  small.factor = *std::min_element(factors.begin(), factors.end());
  return small;
}

struct Points {
  std::vector<Eigen::Vector3d> reliable;  // in the domain
  std::size_t stray = 0;                  // the others in it
  std::size_t pixels = 0;
};

Points pointsOf(const Judgement& judgement) {
  Points points;
  for (const JudgedView& view : judgement.judged.views) {
    points.pixels += view.depth.size();
    for (int y = 0; y < view.depth.height(); ++y) {
      for (int x = 0; x < view.depth.width(); ++x) {
        if (view.depth(x, y) == kInvalidDepth) continue;
        const Eigen::Vector3d point =
            view.world_from_camera * unproject(view.projection, x, y, view.depth(x, y));
        if (!judgement.domain.contains(point)) continue;
        if (view.outlier(x, y) > kDoubtful) {
          ++points.stray;
        } else {
          points.reliable.push_back(point);
        }
      }
    }
  }
  return points;
}

std::size_t occupiedCubes(const std::vector<Eigen::Vector3d>& points, const Box& domain, double side) {
  std::unordered_set<std::uint64_t> cubes;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Matrix<std::uint64_t, 3, 1> cube = ((point - domain.min()) / side).cast<std::uint64_t>();
    cubes.insert(cube.x() | cube.y() << 21 | cube.z() << 42);
  }
  return cubes.size();
}

// A plane of area A meets 1.5 A/side² cubes, a mean over its directions; noise makes it thicker, and with few
// points a cube some are not hit.
double measuredArea(const std::vector<Eigen::Vector3d>& points, const Box& domain, double side,
                    double noise) {
  constexpr double kCubesPerSquare = 1.5;
  const auto cubes = static_cast<double>(occupiedCubes(points, domain, side));
  return cubes * side * side / (kCubesPerSquare + noise / side);
}

}  // namespace

std::optional<Survey> surveyScan(const ViewSequence& sequence, const ReconstructOptions& options,
                                 const Progress& progress) {
  SmallViews small = loadSmall(sequence, progress);
  Survey survey;
  CalibrationReport report;
  Judgement judgement;
  try {
    const DepthStatistics depths = depthStatistics(small.views, options.domain);
    const ViewGraph graph = makeGraph(small.views, depths);
    const SensorModel sensor = calibrateSensor(small.views, graph, depths, options, report, {});
    ReconstructOptions quick = options;
    quick.judge.denial = JudgeOptions::Denial::Skip;
    judgement = judgeViews(std::move(small.views), sensor, graph, quick, report, {});
  } catch (const InvalidArgument&) {
    return std::nullopt;  // they overlap nowhere; all of them may
  }
  survey.domain = judgement.domain;
  survey.noise_scale = report.noise_scale, survey.median_depth = report.median_depth;
  survey.point_spacing = report.point_spacing / small.factor;
  const double side = std::max(
      {3 * report.point_spacing, 4 * report.noise_scale, survey.domain.sizes().maxCoeff() / (1 << 20)});
  const Points points = pointsOf(judgement);
  survey.area = measuredArea(points.reliable, survey.domain, side, report.noise_scale);
  survey.stray_share = static_cast<double>(points.stray) / static_cast<double>(points.pixels);
  return survey;
}

}  // namespace vdbfuse
