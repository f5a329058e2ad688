// SPDX-License-Identifier: Apache-2.0
#include "surface/variation_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/variation_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Row = hn::CappedTag<float, 8>;

void ascendRows(const PaddedBlock<0, 1>& u, const float* price, RowMask rows, float* dual) {
  const Row d;
  const auto step = hn::Set(d, kDualStep * 0.70710678f), eighth = hn::Set(d, 0.125f);
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows), x = row >> 3, y = row & 7;
    for (std::size_t z = 0; z < 8; z += hn::Lanes(d)) {
      const auto load = [&](int dx, int dy, std::size_t dz) {
        return hn::LoadU(d, &u.values[PaddedBlock<0, 1>::place(x + dx, y + dy, 0) + z + dz]);
      };
      const auto u0 = load(0, 0, 0), u1 = load(0, 0, 1), u2 = load(0, 1, 0), u3 = load(0, 1, 1),
                 u4 = load(1, 0, 0), u5 = load(1, 0, 1), u6 = load(1, 1, 0), u7 = load(1, 1, 1);
      const auto sum =
          hn::Add(hn::Add(hn::Add(u0, u1), hn::Add(u2, u3)), hn::Add(hn::Add(u4, u5), hn::Add(u6, u7)));
      const auto mean = hn::Mul(sum, eighth);
      float* p = dual + dualPlace(8 * static_cast<std::size_t>(row), 0) + z;
      const auto moved = [&](std::size_t corner, auto value) {
        return hn::MulAdd(step, hn::Sub(value, mean), hn::LoadU(d, p + 8 * corner));
      };
      const auto p0 = moved(0, u0), p1 = moved(1, u1), p2 = moved(2, u2), p3 = moved(3, u3),
                 p4 = moved(4, u4), p5 = moved(5, u5), p6 = moved(6, u6), p7 = moved(7, u7);
      auto squares = hn::Mul(p0, p0);
      squares = hn::MulAdd(p1, p1, squares), squares = hn::MulAdd(p2, p2, squares);
      squares = hn::MulAdd(p3, p3, squares), squares = hn::MulAdd(p4, p4, squares);
      squares = hn::MulAdd(p5, p5, squares), squares = hn::MulAdd(p6, p6, squares);
      squares = hn::MulAdd(p7, p7, squares);
      const auto limit = hn::LoadU(d, price + static_cast<std::size_t>(8 * row) + z);
      const auto length = hn::Sqrt(hn::Max(squares, hn::Set(d, 1e-30f)));
      const auto scale = hn::Min(hn::Set(d, 1.0f), hn::Div(limit, length));
      const auto store = [&](std::size_t corner, auto value) {
        hn::StoreU(hn::Mul(value, scale), d, p + 8 * corner);
      };
      store(0, p0), store(1, p1), store(2, p2), store(3, p3);
      store(4, p4), store(5, p5), store(6, p6), store(7, p7);
    }
  }
}

// Kᵀp + f of a row of cells.
HWY_INLINE void divergence(const DualPatch& dual, const float* evidence, int row, float* out) {
  const Row d;
  const int x = row >> 3, y = row & 7;
  alignas(32) float straight[8] = {}, shifted[9] = {};
  for (int dx = 0; dx < 2; ++dx) {
    for (int dy = 0; dy < 2; ++dy) {
      const int bx = x < dx ? 4 : 0, by = y < dy ? 2 : 0;
      const std::size_t from = leafPlace({x - dx, y - dy, 0});
      const float* own = dual.below[bx + by];
      const float* below = dual.below[bx + by + 1];
      const std::size_t corner = static_cast<std::size_t>(4 * dx + 2 * dy);
      const float* p0 = own + dualPlace(from, corner);
      const float* p1 = own + dualPlace(from, corner + 1);
      shifted[0] += below[dualPlace(from, corner + 1) + 7];
      for (std::size_t z = 0; z < 8; z += hn::Lanes(d)) {
        hn::StoreU(hn::Add(hn::LoadU(d, straight + z), hn::LoadU(d, p0 + z)), d, straight + z);
        hn::StoreU(hn::Add(hn::LoadU(d, shifted + 1 + z), hn::LoadU(d, p1 + z)), d, shifted + 1 + z);
      }
    }
  }
  const auto scale = hn::Set(d, 0.70710678f);
  for (std::size_t z = 0; z < 8; z += hn::Lanes(d)) {
    const auto sum = hn::Add(hn::LoadU(d, straight + z), hn::LoadU(d, shifted + z));
    hn::StoreU(hn::MulAdd(scale, sum, hn::LoadU(d, evidence + 8 * row + z)), d, out + z);
  }
}

void descendRows(const DualPatch& dual, const float* evidence, const float* free, RowMask rows, float* u,
                 float* ahead) {
  const Row d;
  for (; rows != 0; rows &= rows - 1) {
    const int row = __builtin_ctzll(rows);
    alignas(32) float slope[8];
    divergence(dual, evidence, row, slope);
    for (std::size_t z = 0; z < 8; z += hn::Lanes(d)) {
      const std::size_t i = static_cast<std::size_t>(8 * row) + z;
      const auto old = hn::LoadU(d, u + i);
      const auto step = hn::Mul(hn::Set(d, kPrimalStep), hn::LoadU(d, free + i));
      auto next = hn::NegMulAdd(step, hn::LoadU(d, slope + z), old);
      next = hn::Min(hn::Max(next, hn::Zero(d)), hn::Set(d, 1.0f));
      hn::StoreU(next, d, u + i);
      hn::StoreU(hn::Sub(hn::Add(next, next), old), d, ahead + i);
    }
  }
}

void slopesRows(const DualPatch& dual, const float* evidence, float* out) {
  for (int row = 0; row < 64; ++row) divergence(dual, evidence, row, out + 8 * row);
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse {
namespace {

HWY_EXPORT(ascendRows);
HWY_EXPORT(descendRows);
HWY_EXPORT(slopesRows);

}  // namespace

void ascend(const PaddedBlock<0, 1>& ahead, const float* price, RowMask rows, float* dual) {
  HWY_DYNAMIC_DISPATCH(ascendRows)(ahead, price, rows, dual);
}

void descend(const DualPatch& dual, const float* evidence, const float* free, RowMask rows, float* u,
             float* ahead) {
  HWY_DYNAMIC_DISPATCH(descendRows)(dual, evidence, free, rows, u, ahead);
}

void slopes(const DualPatch& dual, const float* evidence, float* out) {
  HWY_DYNAMIC_DISPATCH(slopesRows)(dual, evidence, out);
}

}  // namespace vdbfuse
#endif
