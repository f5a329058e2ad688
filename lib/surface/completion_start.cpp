// SPDX-License-Identifier: Apache-2.0
#include "surface/completion_start.h"

#include <cmath>

namespace vdbfuse {
namespace {

constexpr float kLabelled = 0.01f;  // least distance of a measured voxel's u from ½, on its label's side
// Cells that are so many levels coarser than the one being solved keep what their own level found: the
// surface is smooth there, far from everything that was measured.
constexpr int kLevelsAhead = 3;

bool isInDomain(std::uint8_t level) { return level != PyramidBlock::kBeyond; }
bool isWhole(std::uint8_t level) { return isInDomain(level) && level != PyramidBlock::kMixed; }

// u of the coarser level around a block: 6³ cells, the first one before it.
struct CoarsePatch {
  static constexpr int kSide = 6;
  std::array<float, kSide * kSide * kSide> values;

  CoarsePatch(const LevelReader& reader, int level, const Index3& origin) {
    reader.readCube(level, origin / 2 - Index3::Ones(), kSide, values.data());
  }

  // Trilinear, between the centres of the coarser cells.
  float at(const Index3& cell) const {
    float sum = 0;
    for (int k = 0; k < 8; ++k) {
      int place = 0;
      float weight = 1;
      for (int a = 0; a < 3; ++a) {
        const bool further = (k >> a & 1) != 0;
        const int parent = cell[a] / 2 + 1, next = cell[a] % 2 == 0 ? parent - 1 : parent + 1;
        place = place * kSide + (further ? next : parent);
        weight *= further ? 0.25f : 0.75f;
      }
      sum += weight * values[static_cast<std::size_t>(place)];
    }
    return sum;
  }
};

}  // namespace

void CompletionStart::read(int level, const Index3& origin, StartBlock& out) const {
  PyramidBlock cells;
  pyramid_.read(level, origin, cells);
  out.u = cells.solid, out.evidence = cells.evidence, out.support = cells.support;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const bool moves = isWhole(cells.level[i]) && cells.level[i] >= level &&
                       (isCoarsest(level) || cells.level[i] <= level + kLevelsAhead) &&
                       cells.support[i] < data_.supported;
    out.may_move[i] = moves ? 1.0f : 0.0f;
  }
  if (std::any_of(cells.level.begin(), cells.level.end(), isInDomain)) {
    if (!isCoarsest(level)) readCoarser(level, origin, cells, out);
    if (level == 0) readMeasurements(origin, cells, out);
  }
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    if (!isInDomain(cells.level[i])) out.support[i] = StartBlock::kBeyondDomain;
  }
}

void CompletionStart::readCoarser(int level, const Index3& origin, const PyramidBlock& cells,
                                  StartBlock& out) const {
  const auto is_coarser = [&](std::uint8_t own) { return isWhole(own) && own > level; };
  if (std::none_of(cells.level.begin(), cells.level.end(), is_coarser)) return;
  const CoarsePatch coarse(LevelReader(pyramid_, levels_), level + 1, origin);
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    if (is_coarser(cells.level[i])) out.u[i] = coarse.at(leafOffset(static_cast<int>(i)));
  }
}

void CompletionStart::readMeasurements(const Index3& origin, const PyramidBlock& cells,
                                       StartBlock& out) const {
  const Index3 place = pyramid_.octree().origin + origin;
  const std::optional<std::size_t> agreement = data_.support.findLeaf(place);
  const std::uint32_t block = data_.blocks.find(place);
  const auto ramp = static_cast<float>(1 / (kRampVoxels * pyramid_.octree().frame.voxel));
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    out.support[i] = agreement ? data_.support.leaf(*agreement).values[i] : data_.support.background();
    const float distance = block == kNoBlock ? kUnknown : data_.distances[block * kBlockSize + i];
    const bool is_measured = !std::isnan(distance);
    if (out.support[i] < data_.supported && !is_measured) continue;
    const float label = cells.solid[i];
    out.may_move[i] = 0;
    out.u[i] = label;
    if (!is_measured) continue;
    const float u = std::clamp(0.5f - ramp * distance, 0.0f, 1.0f);
    out.u[i] = isInside(label) ? std::max(u, 0.5f + kLabelled) : std::min(u, 0.5f - kLabelled);
  }
}

}  // namespace vdbfuse
