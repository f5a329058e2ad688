// SPDX-License-Identifier: Apache-2.0
#include "surface/completion.h"

#include <algorithm>
#include <cmath>

#include "surface/variation.h"
#include "surface/variation_kernels.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kSize = BlockSet::kBlockSize;
constexpr std::size_t kBlocksPerTask = 16;
constexpr int kBand = 2;         // cells around the surface in which it may move
constexpr int kReach = 4;        // cells around it that are kept
constexpr int kSteps = 40;       // between two looks at the gap and at the band
constexpr double kDense = 64e3;  // cells of the coarsest level, of which all are kept
constexpr float kRampVoxels = 4.0f;
constexpr float kLabelled = 0.01f;  // least distance of a measured voxel's u from ½, on its label's side

bool isInside(float u) { return u > 0.5f; }

Index3 blockOf(const Index3& cell) { return {cell.x() & ~7, cell.y() & ~7, cell.z() & ~7}; }
std::size_t placeIn(const Index3& cell) {
  return static_cast<std::size_t>((cell.x() & 7) * 64 + (cell.y() & 7) * 8 + (cell.z() & 7));
}

void appendBlocks(const Index3& low, const Index3& high, std::vector<Index3>& out) {
  const Index3 first = blockOf(low), last = blockOf(high);
  for (int x = first.x(); x <= last.x(); x += 8) {
    for (int y = first.y(); y <= last.y(); y += 8) {
      for (int z = first.z(); z <= last.z(); z += 8) out.emplace_back(x, y, z);
    }
  }
}

template <class Visit>
void forEachBlock(std::size_t count, const Visit& visit) {
  parallelFor(count, kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) visit(b);
  });
}

// Lists made block by block, joined in their order.
std::vector<Index3> gather(std::vector<std::vector<Index3>> parts) {
  std::vector<Index3> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  sortUniqueOrigins(all);
  return all;
}

// Looks u up from one level upwards.
class LevelReader {
 public:
  LevelReader(const CellPyramid& pyramid, const std::vector<CompletionLevel>& levels)
      : pyramid_(pyramid), levels_(levels) {}

  float at(int level, const Index3& cell) const {
    const CompletionLevel& own = levels_[static_cast<std::size_t>(level)];
    if (const std::uint32_t b = own.blocks.find(blockOf(cell)); b != kNoBlock)
      return own.u[b * kSize + placeIn(cell)];
    const Octree& octree = pyramid_.octree();
    const Index3 voxel = cell * (1 << level) + Index3::Constant(level > 0 ? 1 << (level - 1) : 0);
    const std::optional<std::size_t> found = octree.find(octree.origin + voxel);
    if (!found) return pyramid_.beyond();
    const bool coarser = octree.levels[*found] > level && level + 1 < static_cast<int>(levels_.size());
    return coarser ? at(level + 1, Index3(cell.unaryExpr([](int i) { return i >> 1; })))
                   : pyramid_.solidAt(*found);
  }

 private:
  const CellPyramid& pyramid_;
  const std::vector<CompletionLevel>& levels_;
};

// One level, before and while it is solved.
struct LevelProblem {
  VariationProblem variation;  // without its free cells
  std::vector<float> may_move;
};

class Completer {
 public:
  Completer(const CellPyramid& pyramid, const CellTiles& tiles, const ScalarGrid& support,
            const BlockSet& blocks, const std::vector<float>& measured, float supported,
            const CompletionOptions& options)
      : pyramid_(pyramid),
        octree_(pyramid.octree()),
        tiles_(tiles),
        support_(support),
        blocks_(blocks),
        measured_(measured),
        supported_(supported),
        options_(options) {
    coarsest_ = 0;
    const auto cells = [&](int level) { return (octree_.size / (1 << level)).cast<double>().prod(); };
    while (coarsest_ < octree_.max_level && cells(coarsest_) > kDense) ++coarsest_;
    levels_.resize(static_cast<std::size_t>(coarsest_) + 1);
  }

  Completion run(const CellPyramid& pyramid, const Progress& progress) {
    ProgressStep step(progress, "complete surface", levels_.size());
    for (int level = coarsest_; level >= 0; --level) {
      solve(level);
      step.advance();
    }
    return {pyramid, std::move(levels_), report_};
  }

 private:
  CompletionLevel& own(int level) { return levels_[static_cast<std::size_t>(level)]; }

  // Blocks that may hold the surface of a level where it may move.
  std::vector<Index3> candidates(int level) const {
    if (level == coarsest_) return allBlocks(level);
    std::vector<Index3> blocks = aroundCoarser(level);
    const auto append = [&](const CellFace& face) {
      const bool movable = mayMove(level, face.first) || mayMove(level, face.second);
      if (!movable || labelOf(face.first) == labelOf(face.second)) return;
      Index3 low = octree_.lowest(face.first) - octree_.origin;
      Index3 high = low.array() + (octree_.side(face.first) - 1);
      low[face.axis] = high[face.axis] = face.direction > 0 ? high[face.axis] : low[face.axis];
      const Index3 scale = Index3::Constant(1 << level);
      appendBlocks(low.cwiseQuotient(scale).array() - kReach, high.cwiseQuotient(scale).array() + kReach,
                   blocks);
    };
    forEachFace(tiles_, append);
    sortUniqueOrigins(blocks);
    return blocks;
  }

  float labelOf(std::size_t cell) const { return pyramid_.solidAt(cell); }
  bool mayMove(int level, std::size_t cell) const {
    return octree_.levels[cell] >= level && pyramid_.supportOf(cell) < supported_;
  }

  std::vector<Index3> allBlocks(int level) const {
    std::vector<Index3> blocks;
    const Index3 size = octree_.size / (1 << level);
    appendBlocks(Index3::Constant(-1), size, blocks);
    return blocks;
  }

  std::vector<Index3> aroundCoarser(int level) const {
    const CompletionLevel& coarse = levels_[static_cast<std::size_t>(level) + 1];
    std::vector<std::vector<Index3>> parts(coarse.blocks.count());
    forEachBlock(parts.size(), [&](std::size_t b) {
      const Index3 origin = coarse.blocks.origin(b);
      forEachChange(coarse.blocks, coarse.u, coarse.free, b, [&](const Index3& cell) {
        const Index3 low = 2 * (origin + cell);
        appendBlocks(low.array() - kReach, low.array() + (1 + kReach), parts[b]);
      });
      sortUniqueOrigins(parts[b]);
    });
    return gather(std::move(parts));
  }

  // Cells of a block that have another side than a neighbour, one of both free.
  template <class Visit>
  static void forEachChange(const BlockSet& blocks, const std::vector<float>& u,
                            const std::vector<float>& free, std::size_t block, const Visit& visit) {
    PaddedBlock<1, 1> near, movable;
    loadPadded(blocks, u.data(), block, kUnknown, near);
    loadPadded(blocks, free.data(), block, 0.0f, movable);
    for (int i = 0; i < static_cast<int>(kSize); ++i) {
      const Index3 c = leafOffset(i);
      const float value = near.at(c.x(), c.y(), c.z());
      const bool can = movable.at(c.x(), c.y(), c.z()) > 0;
      bool changes = false;
      for (int n = 0; n < 6 && !changes; ++n) {
        const Index3 o = c + (n % 2 * 2 - 1) * Index3(Index3::Unit(n / 2));
        const float other = near.at(o.x(), o.y(), o.z());
        changes = !std::isnan(other) && isInside(other) != isInside(value) &&
                  (can || movable.at(o.x(), o.y(), o.z()) > 0);
      }
      if (changes) visit(c);
    }
  }

  // u, f, C and the cells that may move, of a block of a level.
  struct Start {
    std::array<float, kSize> u, evidence, support, may_move;
  };

  void start(int level, const Index3& origin, Start& out) const {
    PyramidBlock cells;
    pyramid_.read(level, origin, cells);
    out.u = cells.solid, out.evidence = cells.evidence, out.support = cells.support;
    const bool is_domain = std::any_of(cells.level.begin(), cells.level.end(),
                                       [](std::uint8_t l) { return l != PyramidBlock::kBeyond; });
    for (std::size_t i = 0; i < kSize; ++i) {
      const bool whole = cells.level[i] >= level && cells.level[i] < PyramidBlock::kMixed;
      out.may_move[i] = whole && cells.support[i] < supported_ ? 1.0f : 0.0f;
    }
    if (is_domain && level < coarsest_) fromCoarser(level, origin, cells, out.u);
    if (is_domain && level == 0) fromMeasurements(origin, cells, out);
    for (std::size_t i = 0; i < kSize; ++i) {
      if (cells.level[i] == PyramidBlock::kBeyond) out.support[i] = kBeyondDomain;
    }
  }

  // Trilinear, between the centres of the coarser level's cells.
  void fromCoarser(int level, const Index3& origin, const PyramidBlock& cells,
                   std::array<float, kSize>& u) const {
    const auto coarser = [&](std::size_t i) {
      return cells.level[i] > level && cells.level[i] < PyramidBlock::kMixed;
    };
    bool any = false;
    for (std::size_t i = 0; i < kSize && !any; ++i) any = coarser(i);
    if (!any) return;
    constexpr int kSide = 6;
    std::array<float, kSide * kSide * kSide> around;
    const Index3 low = origin / 2 - Index3::Ones();
    const LevelReader reader(pyramid_, levels_);
    for (int k = 0; k < kSide * kSide * kSide; ++k)
      around[static_cast<std::size_t>(k)] =
          reader.at(level + 1, low + Index3(k / (kSide * kSide), k / kSide % kSide, k % kSide));
    for (int i = 0; i < static_cast<int>(kSize); ++i) {
      if (!coarser(static_cast<std::size_t>(i))) continue;
      const Index3 c = leafOffset(i);
      float sum = 0;
      for (int k = 0; k < 8; ++k) {
        const Index3 far(k >> 2, k >> 1 & 1, k & 1);
        float weight = 1;
        Index3 from;
        for (int a = 0; a < 3; ++a) {
          from[a] = c[a] / 2 + 1 + far[a] * (c[a] % 2 == 0 ? -1 : 1);
          weight *= far[a] ? 0.25f : 0.75f;
        }
        sum += weight *
               around[static_cast<std::size_t>((from.x() * kSide + from.y()) * kSide + from.z())];
      }
      u[static_cast<std::size_t>(i)] = sum;
    }
  }

  // Supported voxels keep their labels, and say how far the surface is.
  void fromMeasurements(const Index3& origin, const PyramidBlock& cells, Start& out) const {
    const Index3 place = octree_.origin + origin;
    const std::optional<std::size_t> agreement = support_.findLeaf(place);
    const std::uint32_t distances = blocks_.find(place);
    const float background = support_.background();
    const auto ramp = static_cast<float>(1 / (kRampVoxels * octree_.frame.voxel));
    for (std::size_t i = 0; i < kSize; ++i) {
      const float c = agreement ? support_.leaf(*agreement).values[i] : background;
      const float t = distances == kNoBlock ? kUnknown : measured_[distances * kSize + i];
      out.support[i] = c;
      if (c < supported_ && std::isnan(t)) continue;
      out.may_move[i] = 0;
      const float label = cells.solid[i];
      out.u[i] = label;
      if (std::isnan(t)) continue;
      const float u = std::clamp(0.5f - ramp * t, 0.0f, 1.0f);
      out.u[i] = isInside(label) ? std::max(u, 0.5f + kLabelled) : std::min(u, 0.5f - kLabelled);
    }
  }

  template <class Use>
  void startBlocks(int level, const BlockSet& blocks, const Use& use) const {
    forEachBlock(blocks.count(), [&](std::size_t b) {
      Start values;
      start(level, blocks.origin(b), values);
      use(b, values);
    });
  }

  // Blocks within reach of the surface where it may move.
  BlockSet relevant(int level) const {
    const BlockSet near(candidates(level));
    if (level == coarsest_) return near;
    std::vector<float> u(near.count() * kSize), may_move(near.count() * kSize);
    startBlocks(level, near, [&](std::size_t b, const Start& values) {
      std::copy(values.u.begin(), values.u.end(), &u[b * kSize]);
      std::copy(values.may_move.begin(), values.may_move.end(), &may_move[b * kSize]);
    });
    std::vector<std::vector<Index3>> parts(near.count());
    forEachBlock(parts.size(), [&](std::size_t b) {
      Index3 low = Index3::Constant(8), high = Index3::Constant(-1);
      forEachChange(near, u, may_move, b, [&](const Index3& cell) {
        low = low.cwiseMin(cell), high = high.cwiseMax(cell);
      });
      if (high.x() < 0) return;
      appendBlocks(near.origin(b) + low - Index3::Constant(kReach),
                   near.origin(b) + high + Index3::Constant(kReach), parts[b]);
    });
    return BlockSet(gather(std::move(parts)));
  }

  LevelProblem prepare(int level, CompletionLevel& out) const {
    const std::size_t size = out.blocks.count() * kSize;
    LevelProblem problem;
    problem.variation.blocks = &out.blocks;
    problem.variation.evidence.resize(size);
    problem.may_move.resize(size);
    out.u.resize(size);
    std::vector<float> support(size);
    startBlocks(level, out.blocks, [&](std::size_t b, const Start& values) {
      std::copy(values.u.begin(), values.u.end(), &out.u[b * kSize]);
      std::copy(values.evidence.begin(), values.evidence.end(), &problem.variation.evidence[b * kSize]);
      std::copy(values.support.begin(), values.support.end(), &support[b * kSize]);
      std::copy(values.may_move.begin(), values.may_move.end(), &problem.may_move[b * kSize]);
    });
    problem.variation.price = cubePrices(out.blocks, support);
    return problem;
  }

  // ρ̄ at the corners that eight cells share. Beyond the domain matter is or is not, or nothing is said.
  std::vector<float> cubePrices(const BlockSet& blocks, const std::vector<float>& support) const {
    std::vector<float> prices(support.size());
    const bool free_border = pyramid_.energy().border == Border::Free;
    forEachBlock(blocks.count(), [&](std::size_t b) {
      PaddedBlock<0, 1> c;
      loadPadded(blocks, support.data(), b, kBeyondDomain, c);
      for (int i = 0; i < static_cast<int>(kSize); ++i) {
        const Index3 cell = leafOffset(i);
        float sum = 0;
        bool beyond = false;
        for (int k = 0; k < 8; ++k) {
          const float value = c.at(cell.x() + (k >> 2), cell.y() + (k >> 1 & 1), cell.z() + (k & 1));
          beyond |= value == kBeyondDomain;
          sum += std::max(value, 0.0f);
        }
        const float price = std::exp(-static_cast<float>(pyramid_.energy().mu) * sum / 8);
        prices[b * kSize + static_cast<std::size_t>(i)] = beyond && free_border ? 0.0f : price;
      }
    });
    return prices;
  }

  // Cells that may move, within kBand cells of the surface.
  static std::vector<float> band(const CompletionLevel& level, const std::vector<float>& may_move) {
    std::vector<float> marks(may_move.size()), free(may_move.size());
    forEachBlock(level.blocks.count(), [&](std::size_t b) {
      forEachChange(level.blocks, level.u, may_move, b,
                    [&](const Index3& cell) { marks[b * kSize + placeIn(cell)] = 1; });
    });
    forEachBlock(level.blocks.count(), [&](std::size_t b) {
      PaddedBlock<kBand, kBand> near;
      loadPadded(level.blocks, marks.data(), b, 0.0f, near);
      for (int axis = 0; axis < 3; ++axis) widen(near, axis);
      for (std::size_t i = 0; i < kSize; ++i) {
        const Index3 c = leafOffset(static_cast<int>(i));
        free[b * kSize + i] = may_move[b * kSize + i] * near.at(c.x(), c.y(), c.z());
      }
    });
    return free;
  }

  // The largest value within kBand cells along an axis.
  static void widen(PaddedBlock<kBand, kBand>& block, int axis) {
    const PaddedBlock<kBand, kBand> in = block;
    const Index3 step = Index3::Unit(axis);
    Index3 low = Index3::Constant(-kBand), high = Index3::Constant(8 + kBand);
    for (int a = 0; a <= axis; ++a) low[a] = 0, high[a] = 8;
    for (int x = low.x(); x < high.x(); ++x) {
      for (int y = low.y(); y < high.y(); ++y) {
        for (int z = low.z(); z < high.z(); ++z) {
          float largest = 0;
          for (int k = -kBand; k <= kBand; ++k)
            largest = std::max(largest, in.at(x + k * step.x(), y + k * step.y(), z + k * step.z()));
          block.at(x, y, z) = largest;
        }
      }
    }
  }

  // What a coarser level's dual variables say.
  void startDual(int level, const CompletionLevel& out, std::vector<float>& dual) const {
    const CompletionLevel& coarse = levels_[static_cast<std::size_t>(level) + 1];
    dual.assign(out.blocks.count() * kDualSize, 0.0f);
    forEachBlock(out.blocks.count(), [&](std::size_t b) {
      for (int i = 0; i < static_cast<int>(kSize); ++i) {
        const Index3 cube = out.blocks.origin(b) + leafOffset(i);
        const Index3 parent = cube.unaryExpr([](int v) { return v >> 1; });
        const std::uint32_t from = coarse.blocks.find(blockOf(parent));
        if (from == kNoBlock) continue;
        for (std::size_t corner = 0; corner < 8; ++corner)
          dual[b * kDualSize + corner * kSize + static_cast<std::size_t>(i)] =
              coarse_dual_[from * kDualSize + corner * kSize + placeIn(parent)];
      }
    });
  }

  // Whether nothing is free, or the energy is known and the band has come to rest.
  bool rests(const std::vector<float>& free, const std::vector<float>& before, const VariationGap& gap) const {
    std::size_t cells = 0, changed = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
      cells += free[i] > 0;
      changed += before.empty() || free[i] != before[i];
    }
    if (cells == 0) return true;
    return gap.primal - gap.dual <= options_.tolerance * gap.area &&
           static_cast<double>(changed) <= options_.tolerance * static_cast<double>(cells);
  }

  void solve(int level) {
    CompletionLevel& out = own(level);
    out.blocks = relevant(level);
    LevelProblem problem = prepare(level, out);
    VariationState state;
    state.u = std::move(out.u);
    if (level < coarsest_) startDual(level, out, state.dual);
    VariationGap gap;
    int round = 0;
    for (; round < options_.max_rounds; ++round) {
      out.u = std::move(state.u);
      std::vector<float> free = level == coarsest_ ? problem.may_move : band(out, problem.may_move);
      state.u = std::move(out.u);
      if (rests(free, problem.variation.free, gap)) break;
      problem.variation.free = std::move(free);
      iterate(problem.variation, kSteps, state);
      gap = gapOf(problem.variation, state);
    }
    out.u = std::move(state.u);
    out.free = problem.variation.free.empty() ? std::vector<float>(out.u.size()) : std::move(problem.variation.free);
    coarse_dual_ = std::move(state.dual);
    if (coarse_dual_.empty()) coarse_dual_.assign(out.blocks.count() * kDualSize, 0.0f);
    if (getenv("TVLOG")) fprintf(stderr, "level %d: %zu blocks, free %.0f, rounds %d primal %.1f dual %.1f area %.1f gap/area %.4f\n", level, out.blocks.count(), [&]{double s=0; for(float f:out.free) s+=f; return s;}(), round, gap.primal, gap.dual, gap.area, (gap.primal-gap.dual)/gap.area);
    report_ = {gap.primal, gap.dual, gap.area, round * kSteps};
  }

  static constexpr float kBeyondDomain = -1.0f;

  const CellPyramid& pyramid_;
  const Octree& octree_;
  const CellTiles& tiles_;
  const ScalarGrid& support_;
  const BlockSet& blocks_;  // of the measurements
  const std::vector<float>& measured_;
  float supported_;
  CompletionOptions options_;
  int coarsest_ = 0;
  std::vector<CompletionLevel> levels_;
  std::vector<float> coarse_dual_;
  CompletionReport report_;
};

}  // namespace

void Completion::appendBlocks(std::vector<Index3>& origins) const {
  for (const Index3& origin : levels_.front().blocks.origins())
    origins.push_back(origin + pyramid_.octree().origin);
}

void Completion::readSides(const Index3& origin, float* sides) const {
  const Index3 own = origin - pyramid_.octree().origin;
  const CompletionLevel& finest = levels_.front();
  if (const std::uint32_t b = finest.blocks.find(own); b != kNoBlock) {
    for (std::size_t i = 0; i < kSize; ++i) sides[i] = isInside(finest.u[b * kSize + i]) ? -1.0f : 1.0f;
    return;
  }
  PyramidBlock cells;
  pyramid_.read(0, own, cells);
  const LevelReader reader(pyramid_, levels_);
  for (std::size_t i = 0; i < kSize; ++i) {
    float u = cells.solid[i];
    if (levels_.size() > 1 && cells.level[i] > 0 && cells.level[i] < PyramidBlock::kMixed)
      u = reader.at(1, Index3((own + leafOffset(static_cast<int>(i))) / 2));
    sides[i] = isInside(u) ? -1.0f : 1.0f;
  }
}

bool Completion::readDistances(const Index3& origin, float* distances) const {
  const CompletionLevel& finest = levels_.front();
  const std::uint32_t b = finest.blocks.find(origin - pyramid_.octree().origin);
  if (b == kNoBlock) return false;
  const auto ramp = static_cast<float>(kRampVoxels * pyramid_.octree().frame.voxel);
  for (std::size_t i = 0; i < kSize; ++i) {
    const std::size_t cell = b * kSize + i;
    distances[i] = finest.free[cell] > 0 ? ramp * (0.5f - finest.u[cell]) : kUnknown;
  }
  return true;
}

Completion completeSurface(const CellPyramid& pyramid, const CellTiles& tiles, const ScalarGrid& support,
                           const BlockSet& blocks, const std::vector<float>& measured, float supported,
                           const CompletionOptions& options, const Progress& progress) {
  return Completer(pyramid, tiles, support, blocks, measured, supported, options).run(pyramid, progress);
}

}  // namespace vdbfuse
