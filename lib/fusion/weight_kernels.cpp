// SPDX-License-Identifier: Apache-2.0
#include "fusion/weight_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fusion/weight_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Bits of a mask from pixel x on.
template <class D>
HWY_INLINE void storeBits(D d, hn::Mask<D> mask, int x, std::uint64_t* row) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  std::uint64_t bits;
  std::memcpy(&bits, bytes, sizeof bits);
  row[x / 64] |= bits << (x % 64);
  if (x % 64 + static_cast<int>(hn::Lanes(d)) > 64) row[x / 64 + 1] |= bits >> (64 - x % 64);
}

template <class D>
HWY_INLINE hn::Mask<D> loadBits(D d, const std::uint64_t* row, int x) {
  std::uint64_t bits = row[x / 64] >> (x % 64);
  if (x % 64 + static_cast<int>(hn::Lanes(d)) > 64) bits |= row[x / 64 + 1] << (64 - x % 64);
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof bits);
  return hn::LoadMaskBits(d, bytes);
}

// Calls visit(d, x) for vectors that cover 0 … width − 1; the last one overlaps the one before. Narrow rows
// go pixel by pixel.
template <class Visit>
HWY_INLINE void forEachVector(int width, const Visit& visit) {
  const hn::CappedTag<float, 16> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  if (width < lanes) {
    for (int x = 0; x < width; ++x) visit(hn::CappedTag<float, 1>(), x);
    return;
  }
  int x = 0;
  for (; x + lanes <= width; x += lanes) visit(d, x);
  if (x < width) visit(d, width - lanes);
}

void markRow(const DepthRows& rows, const DepthEdge& edge, const EdgeBits& bits) {
  forEachVector(rows.width, [&](auto d, int x) HWY_ATTR {
    using D = decltype(d);
    const auto none = hn::Zero(d);
    const auto relative = hn::Set(d, edge.relative), absolute = hn::Set(d, edge.absolute);
    const auto here = hn::LoadU(d, rows.here + x);
    const auto is_measured = hn::Gt(here, none);
    auto jumps = hn::Gt(none, none), agrees = jumps;
    const auto compare = [&](hn::Vec<D> other) HWY_ATTR {
      const auto least = hn::Min(here, other);
      const auto both = hn::Gt(least, none);
      const auto is_jump = hn::Gt(hn::AbsDiff(here, other), hn::MulAdd(least, relative, absolute));
      jumps = hn::Or(jumps, hn::And(both, is_jump)), agrees = hn::Or(agrees, hn::AndNot(is_jump, both));
    };
    // Beyond an end of the row, and of the image, nothing is measured.
    const int lanes = static_cast<int>(hn::Lanes(d));
    HWY_ALIGN float at_end[16];
    const auto beside = [&](int step) HWY_ATTR {
      for (int i = 0; i < lanes; ++i) {
        const int at = x + i + step;
        at_end[i] = at < 0 || at >= rows.width ? 0.0f : rows.here[at];
      }
      return hn::Load(d, at_end);
    };
    if (rows.above != nullptr) compare(hn::LoadU(d, rows.above + x));
    if (rows.below != nullptr) compare(hn::LoadU(d, rows.below + x));
    compare(x == 0 ? beside(-1) : hn::LoadU(d, rows.here + x - 1));
    compare(x + lanes == rows.width ? beside(1) : hn::LoadU(d, rows.here + x + 1));
    storeBits(d, hn::Not(is_measured), x, bits.missing);
    storeBits(d, jumps, x, bits.jumps);
    storeBits(d, hn::AndNot(agrees, jumps), x, bits.lone);
  });
}

// Cosine between the ray and the normal of a pinhole's pixel, from the differences of 1/z, which is linear on
// a plane: with q = 1/z and rays r = (u, v, 1) the normal is (q_u, q_v, q − u q_u − v q_v), and its product
// with r is q.
template <class D>
HWY_INLINE hn::Vec<D> cosineAt(D d, const DepthRows& rows, const RowWeighting& w, int x) {
  const auto one = hn::Set(d, 1.0f), tiny = hn::Set(d, 1e-30f);
  const auto z = hn::LoadU(d, rows.here + x), left = hn::LoadU(d, rows.here + x - w.radius),
             right = hn::LoadU(d, rows.here + x + w.radius), above = hn::LoadU(d, rows.above + x),
             below = hn::LoadU(d, rows.below + x);
  const auto least = hn::Min(hn::Min(left, right), hn::Min(above, below)),
             most = hn::Max(hn::Max(left, right), hn::Max(above, below));
  const auto is_known =
      hn::And(hn::Gt(least, hn::Zero(d)), hn::Le(hn::Sub(most, least), hn::Mul(z, hn::Set(d, w.jump))));
  const auto slope = [&](hn::Vec<D> before, hn::Vec<D> after, float per) HWY_ATTR {
    return hn::Div(hn::Mul(hn::Set(d, per), hn::Sub(before, after)), hn::Max(hn::Mul(before, after), tiny));
  };
  const auto qu = slope(left, right, w.per_x), qv = slope(above, below, w.per_y);
  const auto u = hn::LoadU(d, w.us + x), v = hn::Set(d, w.v);
  const auto q = hn::Div(one, hn::Max(z, tiny));
  const auto n = hn::NegMulAdd(u, qu, hn::NegMulAdd(v, qv, q));
  const auto normal = hn::MulAdd(qu, qu, hn::MulAdd(qv, qv, hn::Mul(n, n)));
  const auto ray = hn::MulAdd(u, u, hn::MulAdd(v, v, one));
  const auto cosine = hn::Div(q, hn::Sqrt(hn::Max(hn::Mul(normal, ray), tiny)));
  return hn::IfThenElse(is_known, hn::Min(cosine, one), hn::Set(d, kUnknownCosine));
}

void weigh(const DepthRows& rows, const RowWeighting& w, float* weights) {
  forEachVector(rows.width, [&](auto d, int x) HWY_ATTR {
    const auto z = hn::LoadU(d, rows.here + x);
    auto weight = hn::IfThenElseZero(hn::Gt(z, hn::Zero(d)), hn::Set(d, 1.0f));
    if (w.has_noise) {
      const auto depth = hn::Max(z, hn::Set(d, w.noise.vertex));
      const auto s = hn::MulAdd(hn::MulAdd(hn::Set(d, w.noise.quadratic), depth, hn::Set(d, w.noise.linear)),
                                depth, hn::Set(d, w.noise.constant));
      const auto half = hn::Set(d, w.half_voxel_squared);
      weight = hn::Mul(weight, hn::Div(half, hn::MulAdd(s, s, half)));
    }
    if (w.us != nullptr) {
      const auto column = hn::Add(hn::Iota(d, 0.0f), hn::Set(d, static_cast<float>(x)));
      const auto has_neighbours =
          hn::And(hn::Ge(column, hn::Set(d, static_cast<float>(w.radius))),
                  hn::Lt(column, hn::Set(d, static_cast<float>(rows.width - w.radius))));
      // Beside the ends of the row lie other rows.
      const auto cosine = hn::IfThenElse(has_neighbours, cosineAt(d, rows, w, x), hn::Set(d, kUnknownCosine));
      weight = hn::Mul(weight, cosine);
    }
    if (w.bands[0] != nullptr) {
      weight = hn::IfThenZeroElse(loadBits(d, w.lone, x), weight);
      auto ramp = hn::Set(d, 1.0f);
      for (std::size_t band = 3; band-- > 0;)
        ramp = hn::IfThenElse(loadBits(d, w.bands[band], x), hn::Set(d, w.ramp[band]), ramp);
      weight = hn::Mul(weight, ramp);
    }
    hn::StoreU(weight, d, weights + x);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse {
namespace {

HWY_EXPORT(markRow);
HWY_EXPORT(weigh);

}  // namespace

void markEdges(const DepthRows& rows, const DepthEdge& edge, const EdgeBits& bits) {
  HWY_DYNAMIC_DISPATCH(markRow)(rows, edge, bits);
}

void weighRow(const DepthRows& rows, const RowWeighting& weighting, float* weights) {
  HWY_DYNAMIC_DISPATCH(weigh)(rows, weighting, weights);
}

}  // namespace vdbfuse
#endif
