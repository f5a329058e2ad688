// SPDX-License-Identifier: Apache-2.0
#include "fusion/pixel_testimony.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "fusion/block_kernels.h"
#include "fusion/surface_rows.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

constexpr float kAgreeSigmas = 3.0f;
constexpr int kConfirmed = 3;  // this many agreeing neighbours prove a point to be there

std::uint8_t continuityBin(float share) {
  return static_cast<std::uint8_t>((share >= 0.4f) + (share >= 0.7f) + (share >= 0.9f));
}

std::uint8_t occlusionBin(int hidden) { return hidden < 2 ? 0 : hidden == 2 ? 1 : hidden < 5 ? 2 : 3; }

std::uint8_t capped(int count, std::size_t bins) {
  return static_cast<std::uint8_t>(std::min<int>(count, static_cast<int>(bins) - 1));
}

// Looks at confirmed points, and how many of them met nothing.
struct MissCounts {
  double missed = 0, looked = 0;
};

class Hearing {
  static constexpr int kTile = 16, kSquare = 128;
  // Runs that one neighbour is asked about before the next is: as long as what they look at lies in few
  // pages.
  static constexpr std::size_t kGroup = 32;

 public:
  Hearing(const std::vector<View>& views, const std::vector<CompactSurface>& surfaces,
          const SensorModel& sensor, std::size_t index, const std::vector<std::size_t>& neighbours,
          const std::vector<std::vector<std::size_t>>& alternatives)
      : views_(views),
        surfaces_(surfaces),
        sensor_(sensor),
        index_(index),
        neighbours_(neighbours),
        alternatives_(alternatives),
        unprojector_(views[index].projection, views[index].world_from_camera) {
    for (const std::size_t other : neighbours) {
      projectors_.emplace_back(views[other].projection, views[other].world_from_camera);
      variances_.emplace_back(sensor, views[other].projection);
    }
  }

  Image<PixelTestimony> hear(MissCounts& misses) const {
    const Image<float>& depth = views_[index_].map.depth;
    Image<PixelTestimony> result(depth.width(), depth.height(), {}, depth.memory());
    const std::vector<PixelRun> runs = collectRuns();
    std::vector<Inquiry> inquiries(std::min(kGroup, runs.size()));
    for (std::size_t first = 0; first < runs.size(); first += kGroup) {
      const auto group = std::span(runs).subspan(first, std::min(kGroup, runs.size() - first));
      for (std::size_t r = 0; r < group.size(); ++r) prepare(group[r], inquiries[r]);
      for (std::size_t k = 0; k < projectors_.size(); ++k) {
        for (std::size_t r = 0; r < group.size(); ++r) {
          const PointBlock& block = *inquiries[r].block;
          if (projectors_[k].mightSee(block.centre, block.radius)) ask(k, inquiries[r]);
        }
      }
      for (std::size_t r = 0; r < group.size(); ++r) settle(group[r], inquiries[r].answers, misses, result);
    }
    return result;
  }

 private:
  // Pixels that are asked about together.
  struct PixelRun {
    PixelRun() { pixels.reserve(PointBlock::kCapacity), points.reserve(PointBlock::kCapacity); }
    std::vector<std::size_t> pixels;
    std::vector<Eigen::Vector3d> points;
  };

  // What neighbours need to know of the pixels of a run, and what they answer.
  struct Inquiry {
    std::optional<PointBlock> block;
    alignas(64) std::array<float, PointBlock::kCapacity> noise{};  // standard deviations
    BlockNormals normals{};
    BlockAnswers answers;  // by all so far
  };

  // Runs that follow each other lie in one square of the image, and so in the images of the neighbours,
  // whichever way those are turned.
  std::vector<PixelRun> collectRuns() const {
    const Image<float>& depth = views_[index_].map.depth;
    std::vector<PixelRun> runs;
    for (int top = 0; top < depth.height(); top += kSquare) {
      for (int left = 0; left < depth.width(); left += kSquare) addSquare(left, top, runs);
    }
    return runs;
  }

  void addSquare(int left, int top, std::vector<PixelRun>& runs) const {
    const Image<float>& depth = views_[index_].map.depth;
    const int right = std::min(left + kSquare, depth.width()),
              bottom = std::min(top + kSquare, depth.height());
    PixelRun run;
    for (int y = top; y < bottom; y += kTile) {
      for (int x = left; x < right; x += kTile) {
        addTile(x, y, run);
        if (run.points.size() + kTile * kTile <= PointBlock::kCapacity) continue;
        runs.push_back(std::move(run));
        run = {};
      }
    }
    if (!run.points.empty()) runs.push_back(std::move(run));
  }

  void prepare(const PixelRun& run, Inquiry& inquiry) const {
    inquiry.block.emplace(run.points);
    for (std::size_t i = 0; i < run.pixels.size(); ++i) {
      inquiry.noise[i] = static_cast<float>(sensor_.noise.at(views_[index_].map.depth.data()[run.pixels[i]]));
      inquiry.normals[i] = surfaces_[index_].normal.data()[run.pixels[i]];
    }
    inquiry.answers = {};
  }

  void addTile(int left, int top, PixelRun& run) const {
    const View& view = views_[index_];
    const int right = std::min(left + kTile, view.map.depth.width()),
              bottom = std::min(top + kTile, view.map.depth.height());
    for (int y = top; y < bottom; ++y) {
      for (int x = left; x < right; ++x) {
        if (view.map.depth(x, y) == kInvalidDepth) continue;
        run.pixels.push_back(static_cast<std::size_t>(y * view.map.depth.width() + x));
        run.points.push_back(unprojector_(x, y, view.map.depth(x, y)));
      }
    }
  }

  PixelTestimony testimonyOf(std::size_t pixel, const BlockAnswers& answers, std::size_t i) const {
    PixelTestimony testimony;
    testimony.measured = true;
    testimony.agreement = capped(answers.agreeing[i], PixelTestimony::kAgreements) & 7u;
    testimony.contradiction = capped(answers.past[i], PixelTestimony::kContradictions) & 3u;
    testimony.occlusion = occlusionBin(answers.hidden[i]) & 3u;
    testimony.misses = capped(answers.missed[i], PixelTestimony::kMisses) & 7u;
    testimony.continuity = surfaces_[index_].continuity.data()[pixel] & 3u;
    return testimony;
  }

  void settle(const PixelRun& run, const BlockAnswers& answers, MissCounts& misses,
              Image<PixelTestimony>& result) const {
    for (std::size_t i = 0; i < run.pixels.size(); ++i) {
      if (answers.agreeing[i] >= kConfirmed)
        misses.missed += answers.missed[i], misses.looked += answers.missed[i] + answers.agreeing[i];
      result.data()[run.pixels[i]] = testimonyOf(run.pixels[i], answers, i);
    }
  }

  void ask(std::size_t k, Inquiry& inquiry) const {
    const std::size_t other = neighbours_[k];
    const PointBlock& block = *inquiry.block;
    const BlockLook seen = look(projectors_[k], block);
    prefetchLines({views_[other].map.depth.data(), surfaces_[other].normal.data()}, seen, block.size);
    BlockComparison said = answer(k, other, seen, block.size, inquiry);
    if (other < alternatives_.size()) {
      for (const std::size_t layer : alternatives_[other])
        prefer(answer(k, layer, seen, block.size, inquiry), block.size, said);
    }
    if (!views_[other].map.mask.empty()) lookPastObject(views_[other].map, seen, block.size, said);
    count(said, inquiry.normals, views_[other].world_from_camera.translation(), block, inquiry.answers);
  }

  // What view `index`, neighbour k or an alternative of it, says where it saw the points.
  BlockComparison answer(std::size_t k, std::size_t index, const BlockLook& seen, std::size_t size,
                         const Inquiry& inquiry) const {
    BlockComparison comparison = compare(views_[index].map.depth.data(), variances_[k], kAgreeSigmas,
                                         inquiry.noise.data(), seen, size);
    tellSidesApart(inquiry.normals, surfaces_[index].normal.data(), seen, size, comparison);
    return comparison;
  }

  // A view agrees when any of its hypotheses does.
  static void prefer(const BlockComparison& alternative, std::size_t size, BlockComparison& said) {
    for (std::size_t i = 0; i < size; ++i) {
      if (alternative[i] == Measured::Same) said.words[i] = alternative.words[i];
    }
  }

  static void lookPastObject(const DepthMap& map, const BlockLook& seen, std::size_t size,
                             BlockComparison& said) {
    for (std::size_t i = 0; i < size; ++i) {
      const int pixel = seen.pixel[i];
      if (pixel >= 0 && isOutsideMask(map, pixel % map.depth.width(), pixel / map.depth.width()))
        said.words[i] = static_cast<std::int32_t>(Measured::Further);
    }
  }

  const std::vector<View>& views_;
  const std::vector<CompactSurface>& surfaces_;
  const SensorModel& sensor_;
  std::size_t index_;
  const std::vector<std::size_t>& neighbours_;
  const std::vector<std::vector<std::size_t>>& alternatives_;
  Unprojector unprojector_;
  std::vector<Projector> projectors_;
  std::vector<LookupVariance> variances_;
};

}  // namespace

CompactSurface analyseCompactly(const View& view, const NoiseLaw& noise) {
  const int width = view.map.depth.width(), height = view.map.depth.height();
  std::pmr::memory_resource* const memory = view.memory();
  CompactSurface result{Image<PackedNormal>(width, height, {}, memory),
                        Image<std::uint8_t>(width, height, 0, memory),
                        Image<float>(width, height, 0, memory)};
  forEachSurfaceRow(view, noise, [&](int y, const SurfaceRow& row) {
    packNormals(row, result.normal.row(y));
    std::copy_n(row.incidence.begin(), width, result.incidence.row(y));
    std::transform(row.continuity.begin(), row.continuity.begin() + width, result.continuity.row(y),
                   continuityBin);
  });
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
