// SPDX-License-Identifier: Apache-2.0
#include "surface/completion.h"

#include <cmath>

#include "surface/variation.h"
#include "surface/variation_kernels.h"

namespace vdbfuse {
namespace {

constexpr int kBand = 2;         // cells around the surface in which it may move
constexpr int kReach = 4;        // cells around it that are kept
constexpr int kSteps = 25;       // between two looks at the gap and at the band
constexpr double kDense = 64e3;  // cells of the coarsest level, of which all are kept

int coarsestLevel(const Octree& octree) {
  int level = 0;
  while (level < octree.max_level && (octree.size / (1 << level)).cast<double>().prod() > kDense) ++level;
  return level;
}

// ρ̄ of the cubes between eight cells. A border of which nothing is said costs nothing.
std::vector<float> cubePrices(const BlockSet& blocks, const std::vector<float>& support,
                              const CutOptions& energy) {
  std::vector<float> prices(support.size());
  forEachBlock(blocks.count(), [&](std::size_t b) {
    PaddedBlock<0, 1> c;
    loadPadded(blocks, support.data(), b, StartBlock::kBeyondDomain, c);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const Index3 cube = leafOffset(static_cast<int>(i));
      float sum = 0;
      bool is_beyond = false;
      for (int k = 0; k < 8; ++k) {
        const float value = c.at(cube + Index3(k >> 2, k >> 1 & 1, k & 1));
        is_beyond |= value == StartBlock::kBeyondDomain;
        sum += std::max(value, 0.0f);
      }
      const bool is_free = is_beyond && energy.border == Border::Free;
      prices[b * kBlockSize + i] = is_free ? 0.0f : static_cast<float>(energy.cost(sum / 8));
    }
  });
  return prices;
}

// Whether nothing is free, or the energy is known and the band has come to rest.
bool rests(const std::vector<float>& free, const std::vector<float>& before, const VariationGap& gap,
           double tolerance) {
  std::size_t cells = 0, changed = 0;
  for (std::size_t i = 0; i < free.size(); ++i) {
    cells += free[i] > 0;
    changed += before.empty() || free[i] != before[i];
  }
  if (cells == 0) return true;
  return gap.primal - gap.dual <= tolerance * gap.area &&
         static_cast<double>(changed) <= tolerance * static_cast<double>(cells);
}

class Completer {
 public:
  Completer(const CellPyramid& pyramid, const CellTiles& tiles, const CompletionData& data,
            const CompletionOptions& options)
      : pyramid_(pyramid),
        octree_(pyramid.octree()),
        tiles_(tiles),
        options_(options),
        levels_(static_cast<std::size_t>(coarsestLevel(octree_)) + 1),
        start_(pyramid_, levels_, data) {}

  Completion run(const Progress& progress) {
    ProgressStep step(progress, "complete surface", levels_.size());
    for (int level = static_cast<int>(levels_.size()) - 1; level >= 0; --level) {
      solve(level);
      step.advance();
    }
    return {pyramid_, std::move(levels_), report_};
  }

 private:
  // The coarsest level with one layer of cells beyond the domain.
  std::vector<Index3> allBlocks(int level) const {
    std::vector<Index3> blocks;
    appendBlocks(Index3::Constant(-1), octree_.size / (1 << level), blocks);
    return blocks;
  }

  // Blocks that may hold the surface of a level where it may move.
  std::vector<Index3> candidates(int level) const {
    std::vector<Index3> blocks = aroundCoarser(level);
    forEachFace(tiles_, [&](const CellFace& face) {
      if (pyramid_.solidAt(face.first) == pyramid_.solidAt(face.second)) return;
      if (!start_.mayMove(level, face.first) && !start_.mayMove(level, face.second)) return;
      Index3 low = octree_.lowest(face.first) - octree_.origin;
      Index3 high = low.array() + (octree_.side(face.first) - 1);
      low[face.axis] = high[face.axis] = face.direction > 0 ? high[face.axis] : low[face.axis];
      appendBlocks(low / (1 << level) - Index3::Constant(kReach),
                   high / (1 << level) + Index3::Constant(kReach), blocks);
    });
    return blocks;
  }

  std::vector<Index3> aroundCoarser(int level) const {
    const CompletionLevel& coarse = levels_[static_cast<std::size_t>(level) + 1];
    std::vector<std::vector<Index3>> parts(coarse.blocks.count());
    forEachBlock(parts.size(), [&](std::size_t b) {
      forEachChange(coarse.blocks, coarse.u, coarse.free, b, [&](const Index3& cell) {
        const Index3 low = 2 * (coarse.blocks.origin(b) + cell);
        appendBlocks(low - Index3::Constant(kReach), low + Index3::Constant(1 + kReach), parts[b]);
      });
      sortUniqueOrigins(parts[b]);
    });
    return joined(parts);
  }

  // Blocks within reach of the surface where it may move.
  BlockSet relevantBlocks(int level) const {
    if (start_.isCoarsest(level)) return BlockSet(allBlocks(level));
    const BlockSet near(candidates(level));
    std::vector<float> u(near.valueCount()), may_move(near.valueCount());
    forEachBlock(near.count(), [&](std::size_t b) {
      StartBlock values;
      start_.read(level, near.origin(b), values);
      std::copy(values.u.begin(), values.u.end(), &u[b * kBlockSize]);
      std::copy(values.may_move.begin(), values.may_move.end(), &may_move[b * kBlockSize]);
    });
    std::vector<std::vector<Index3>> parts(near.count());
    forEachBlock(parts.size(), [&](std::size_t b) {
      Index3 low = Index3::Constant(8), high = Index3::Constant(-1);
      forEachChange(near, u, may_move, b,
                    [&](const Index3& cell) { low = low.cwiseMin(cell), high = high.cwiseMax(cell); });
      if (high.x() < 0) return;
      appendBlocks(near.origin(b) + low - Index3::Constant(kReach),
                   near.origin(b) + high + Index3::Constant(kReach), parts[b]);
    });
    return BlockSet(joined(parts));
  }

  // The problem without its free cells, u of the level, and which cells may move.
  struct Prepared {
    VariationProblem problem;
    std::vector<float> may_move;
  };
  Prepared prepare(int level, CompletionLevel& own) const {
    const std::size_t size = own.blocks.valueCount();
    Prepared prepared{{&own.blocks, {}, std::vector<float>(size), {}}, std::vector<float>(size)};
    own.u.resize(size);
    std::vector<float> support(size);
    forEachBlock(own.blocks.count(), [&](std::size_t b) {
      StartBlock values;
      start_.read(level, own.blocks.origin(b), values);
      const auto store = [b](const std::array<float, kBlockSize>& from, std::vector<float>& to) {
        std::copy(from.begin(), from.end(), &to[b * kBlockSize]);
      };
      store(values.u, own.u), store(values.support, support);
      store(values.evidence, prepared.problem.evidence), store(values.may_move, prepared.may_move);
    });
    prepared.problem.price = cubePrices(own.blocks, support, pyramid_.energy());
    return prepared;
  }

  // Begins with what the coarser level's dual variables say.
  void startDual(int level, const VariationProblem& problem, VariationState& state) const {
    makeRoom(problem, state);
    if (start_.isCoarsest(level)) return;
    const BlockSet& coarse = levels_[static_cast<std::size_t>(level) + 1].blocks;
    forEachBlock(problem.blocks->count(), [&](std::size_t b) {
      if (state.dual_of[b] == kNoBlock) return;
      float* to = &state.dual[state.dual_of[b] * kDualSize];
      for (std::size_t i = 0; i < kBlockSize; ++i) {
        const Index3 cube = problem.blocks->origin(b) + leafOffset(static_cast<int>(i));
        const Index3 parent(cube.x() >> 1, cube.y() >> 1, cube.z() >> 1);
        const std::uint32_t from = coarse.find(leafOrigin(parent));
        if (from == kNoBlock || coarse_.dual_of[from] == kNoBlock) continue;
        const float* p = &coarse_.dual[coarse_.dual_of[from] * kDualSize];
        for (std::size_t corner = 0; corner < 8; ++corner)
          to[dualPlace(i, corner)] = p[dualPlace(leafPlace(parent), corner)];
      }
    });
    makeRoom(problem, state);
  }

  void solve(int level) {
    CompletionLevel& own = levels_[static_cast<std::size_t>(level)];
    own.blocks = relevantBlocks(level);
    Prepared prepared = prepare(level, own);
    VariationProblem& problem = prepared.problem;
    VariationState state;
    state.u = std::move(own.u);
    VariationGap gap;
    int round = 0;
    for (; round < options_.max_rounds; ++round) {
      std::vector<float> free = start_.isCoarsest(level)
                                    ? prepared.may_move
                                    : movingBand(own.blocks, state.u, prepared.may_move, kBand);
      if (rests(free, problem.free, gap, options_.tolerance)) break;
      problem.free = std::move(free);
      if (round == 0) startDual(level, problem, state);
      iterate(problem, kSteps, state);
      gap = gapOf(problem, state);
    }
    problem.free.resize(state.u.size(), 0.0f);
    report_ = {gap.primal, gap.dual, gap.area, round * kSteps};
    own.u = std::move(state.u), own.free = std::move(problem.free);
    coarse_ = std::move(state);
    coarse_.dual_of.resize(own.blocks.count(), kNoBlock);
  }

  const CellPyramid& pyramid_;
  const Octree& octree_;
  const CellTiles& tiles_;
  CompletionOptions options_;
  std::vector<CompletionLevel> levels_;  // finest first
  CompletionStart start_;
  VariationState coarse_;  // of the level solved last, without u
  CompletionReport report_;
};

}  // namespace

void Completion::appendBlocksTo(std::vector<Index3>& origins) const {
  for (const Index3& origin : levels_.front().blocks.origins())
    origins.push_back(origin + pyramid_.octree().origin);
}

void Completion::readSides(const Index3& origin, float* sides) const {
  const Index3 own = origin - pyramid_.octree().origin;
  const CompletionLevel& finest = levels_.front();
  const auto side = [](float u) { return isInside(u) ? -1.0f : 1.0f; };
  if (const std::uint32_t b = finest.blocks.find(own); b != kNoBlock) {
    std::transform(&finest.u[b * kBlockSize], &finest.u[b * kBlockSize] + kBlockSize, sides, side);
    return;
  }
  PyramidBlock cells;
  pyramid_.read(0, own, cells);
  std::array<float, 64> parents;  // u of the coarser level
  const auto is_coarser = [](std::uint8_t level) { return level > 0 && level < PyramidBlock::kMixed; };
  const bool any = levels_.size() > 1 && std::any_of(cells.level.begin(), cells.level.end(), is_coarser);
  if (any) LevelReader(pyramid_, levels_).readCube(1, own / 2, 4, parents.data());
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const Index3 parent = leafOffset(static_cast<int>(i)) / 2;
    const auto place = static_cast<std::size_t>(parent.x() * 16 + parent.y() * 4 + parent.z());
    sides[i] = side(any && is_coarser(cells.level[i]) ? parents[place] : cells.solid[i]);
  }
}

void Completion::readDistances(const Index3& origin, float* distances) const {
  const CompletionLevel& finest = levels_.front();
  const std::uint32_t b = finest.blocks.find(origin - pyramid_.octree().origin);
  std::fill_n(distances, kBlockSize, kUnknown);
  if (b == kNoBlock) return;
  const auto ramp = static_cast<float>(kRampVoxels * pyramid_.octree().frame.voxel);
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const std::size_t cell = b * kBlockSize + i;
    if (finest.free[cell] > 0) distances[i] = ramp * (0.5f - finest.u[cell]);
  }
}

Completion completeSurface(const CellPyramid& pyramid, const CellTiles& tiles, const CompletionData& data,
                           const CompletionOptions& options, const Progress& progress) {
  return Completer(pyramid, tiles, data, options).run(progress);
}

}  // namespace vdbfuse
