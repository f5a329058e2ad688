// SPDX-License-Identifier: Apache-2.0
#include "fusion/surface_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fusion/surface_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, SurfaceRow::kLanes>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using FloatMask = hn::Mask<Floats>;

HWY_INLINE FloatVec number(float value) { return hn::Set(Floats(), value); }

// Sums over the pixels that continue a surface, for the least-squares plane e = a + b·dx + c·dy in the excess
// of the inverse depth, e = (1/z)/(1/z₀) − 1 = (z₀ − z)/z: nothing large is taken away from anything large.
struct PlaneSums {
  FloatVec count, x, y, xx, xy, yy, e, xe, ye;
  FloatVec valid;  // neighbours with a depth, whether they continue the surface or not
};

// The pixels at (−2 … 2, dy).
HWY_INLINE void addRow(const float* depth, const float* inverse, int dy, FloatVec here, FloatVec near_reach,
                       FloatVec far_reach, PlaneSums& sums) {
  const Floats d;
  constexpr int kRadius = PaddedDepth::kRadius;
  const FloatVec one = number(1), zero = number(0);
  std::array<FloatVec, 2 * kRadius + 1> counts, excesses;
#pragma GCC unroll 5
  for (int dx = -kRadius; dx <= kRadius; ++dx) {
    FloatVec &count = counts[static_cast<std::size_t>(dx + kRadius)],
             &excess = excesses[static_cast<std::size_t>(dx + kRadius)];
    if (dx == 0 && dy == 0) {
      count = one, excess = zero;
      continue;
    }
    const FloatVec other = hn::LoadU(d, depth + dx), nearer = hn::Sub(here, other);
    const FloatMask is_measured = hn::Gt(other, zero);
    const FloatVec reach = std::max(std::abs(dx), std::abs(dy)) == 1 ? near_reach : far_reach;
    const FloatMask continues = hn::And(is_measured, hn::Le(hn::Abs(nearer), reach));
    sums.valid = hn::Add(sums.valid, hn::IfThenElseZero(is_measured, one));
    count = hn::IfThenElseZero(continues, one);
    excess = hn::IfThenElseZero(continues, hn::Mul(nearer, hn::LoadU(d, inverse + dx)));
  }
  const FloatVec two = number(2), four = number(4), line = number(static_cast<float>(dy)),
                 squared = number(static_cast<float>(dy * dy));
  const FloatVec outer = hn::Add(counts[0], counts[4]), inner = hn::Add(counts[1], counts[3]);
  const FloatVec count = hn::Add(hn::Add(outer, inner), counts[2]);
  const FloatVec x = hn::MulAdd(two, hn::Sub(counts[4], counts[0]), hn::Sub(counts[3], counts[1]));
  const FloatVec e =
      hn::Add(hn::Add(hn::Add(excesses[0], excesses[4]), hn::Add(excesses[1], excesses[3])), excesses[2]);
  sums.count = hn::Add(sums.count, count);
  sums.x = hn::Add(sums.x, x);
  sums.xx = hn::Add(sums.xx, hn::MulAdd(four, outer, inner));
  sums.y = hn::MulAdd(line, count, sums.y);
  sums.yy = hn::MulAdd(squared, count, sums.yy);
  sums.xy = hn::MulAdd(line, x, sums.xy);
  sums.e = hn::Add(sums.e, e);
  sums.xe =
      hn::Add(sums.xe, hn::MulAdd(two, hn::Sub(excesses[4], excesses[0]), hn::Sub(excesses[3], excesses[1])));
  sums.ye = hn::MulAdd(line, e, sums.ye);
}

HWY_INLINE FloatVec determinant(FloatVec a, FloatVec b, FloatVec c, FloatVec d) {
  return hn::Sub(hn::Mul(a, d), hn::Mul(b, c));
}

HWY_INLINE FloatVec dot(FloatVec ax, FloatVec ay, FloatVec az, FloatVec bx, FloatVec by, FloatVec bz) {
  return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

struct Plane {
  FloatVec a, b, c;
  FloatMask is_known;  // the pixels do not lie on a line
};

HWY_INLINE Plane fitPlane(const PlaneSums& s) {
  const Floats d;
  // Cofactors are whole numbers, and exact.
  const FloatVec aa = determinant(s.xx, s.xy, s.xy, s.yy), ab = determinant(s.y, s.x, s.yy, s.xy),
                 ac = determinant(s.x, s.y, s.xx, s.xy), bb = determinant(s.count, s.y, s.y, s.yy),
                 bc = determinant(s.x, s.count, s.xy, s.y), cc = determinant(s.count, s.x, s.x, s.xx);
  const FloatVec whole = dot(s.count, s.x, s.y, aa, ab, ac);
  const FloatMask is_known = hn::Ne(whole, hn::Zero(d));
  const FloatVec inverse = hn::Div(number(1), hn::IfThenElse(is_known, whole, number(1)));
  return {hn::Mul(inverse, dot(aa, ab, ac, s.e, s.xe, s.ye)),
          hn::Mul(inverse, dot(ab, bb, bc, s.e, s.xe, s.ye)),
          hn::Mul(inverse, dot(ac, bc, cc, s.e, s.xe, s.ye)), is_known};
}

HWY_INLINE void storeNothing(int x, SurfaceRow& row) {
  const Floats d;
  for (std::vector<float>* part : {&row.x, &row.y, &row.z, &row.incidence, &row.continuity})
    hn::StoreU(hn::Zero(d), d, part->data() + x);
}

// The plane a + b·dx + c·dy of 1/z is n·(point) = 1 with n = (b·fx, c·fy, a + b(cx − x) + c(cy − y)).
HWY_INLINE void storeNormal(const PinholeSurface& surface, int x, int y, const Plane& plane,
                            FloatMask is_wanted, SurfaceRow& row) {
  const Floats d;
  const FloatVec a = hn::Add(number(1), plane.a);
  const FloatVec right = hn::Sub(hn::Iota(d, static_cast<float>(x)), number(surface.cx)),
                 down = number(static_cast<float>(y) - surface.cy);
  const FloatVec nx = hn::Mul(plane.b, number(surface.fx)), ny = hn::Mul(plane.c, number(surface.fy));
  const FloatVec nz = hn::NegMulAdd(plane.b, right, hn::NegMulAdd(plane.c, down, a));
  const FloatVec ray_x = hn::Mul(right, number(1 / surface.fx)),
                 ray_y = hn::Mul(down, number(1 / surface.fy));
  const FloatVec length = hn::Sqrt(dot(nx, ny, nz, nx, ny, nz)),
                 ray = hn::Sqrt(dot(ray_x, ray_y, number(1), ray_x, ray_y, number(1)));
  const FloatVec smallest = hn::Sub(a, hn::Add(hn::Abs(plane.b), hn::Abs(plane.c)));
  const FloatMask is_known = hn::And(hn::And(is_wanted, plane.is_known),
                                     hn::And(hn::Gt(smallest, hn::Zero(d)), hn::Gt(length, hn::Zero(d))));
  const FloatVec inverse = hn::Div(number(1), length);
  float* const parts[3] = {row.x.data() + x, row.y.data() + x, row.z.data() + x};
  for (std::size_t r = 0; r < 3; ++r) {
    const auto& m = surface.world_from_camera[r];
    const FloatVec along = dot(number(m[0]), number(m[1]), number(m[2]), nx, ny, nz);
    hn::StoreU(hn::IfThenElseZero(is_known, hn::Neg(hn::Mul(along, inverse))), d, parts[r]);
  }
  const FloatVec cosine = hn::Min(hn::Mul(hn::Div(a, ray), inverse), number(1));
  hn::StoreU(hn::IfThenElseZero(is_known, cosine), d, row.incidence.data() + x);
}

void analysePinholeRow(const PinholeSurface& surface, const PaddedDepth& padded, int y, SurfaceRow& row) {
  const Floats d;
  const FloatVec zero = hn::Zero(d), least = number(kLeastSurfaceNeighbours);
  const NoiseCurve& reach = surface.reach;
  for (int x = 0; x < row.width; x += static_cast<int>(hn::Lanes(d))) {
    const FloatVec here = hn::LoadU(d, padded.depth(y) + x);
    const FloatMask is_measured = hn::Gt(here, zero);
    if (hn::AllFalse(d, is_measured)) {
      storeNothing(x, row);
      continue;
    }
    const FloatVec risen = hn::Max(here, number(reach.vertex)), slope = hn::Mul(number(surface.slope), here);
    const FloatVec noise = hn::MulAdd(risen, hn::MulAdd(risen, number(reach.quadratic), number(reach.linear)),
                                      number(reach.constant));
    const FloatVec near_reach = hn::Add(noise, slope), far_reach = hn::Add(near_reach, slope);
    PlaneSums sums{zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
#pragma GCC unroll 5
    for (int dy = -PaddedDepth::kRadius; dy <= PaddedDepth::kRadius; ++dy)
      addRow(padded.depth(y + dy) + x, padded.inverse(y + dy) + x, dy, here, near_reach, far_reach, sums);
    const FloatVec neighbours = hn::Sub(sums.count, number(1));
    const FloatVec continuity = hn::Div(neighbours, hn::Max(sums.valid, least));
    hn::StoreU(hn::IfThenElseZero(is_measured, continuity), d, row.continuity.data() + x);
    storeNormal(surface, x, y, fitPlane(sums), hn::And(is_measured, hn::Ge(neighbours, least)), row);
  }
}

// PackedNormal(normal) of many.
void packRow(const SurfaceRow& row, std::int32_t* packed) {
  const Floats d;
  const Ints di;
  const FloatVec one = number(1), zero = hn::Zero(d), largest = number(PackedNormal::kLargest);
  for (int i = 0; i < row.width; i += static_cast<int>(hn::Lanes(d))) {
    const FloatVec x = hn::LoadU(d, row.x.data() + i), y = hn::LoadU(d, row.y.data() + i),
                   z = hn::LoadU(d, row.z.data() + i);
    const FloatVec sum = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
    const FloatMask is_none = hn::Le(sum, zero);
    const FloatVec inverse = hn::Div(one, hn::IfThenElse(is_none, one, sum));
    const FloatVec px = hn::Mul(x, inverse), py = hn::Mul(y, inverse);
    const FloatMask is_folded = hn::Lt(z, zero);
    const FloatVec u = hn::IfThenElse(is_folded, hn::CopySign(hn::Sub(one, hn::Abs(py)), px), px);
    const FloatVec v = hn::IfThenElse(is_folded, hn::CopySign(hn::Sub(one, hn::Abs(px)), py), py);
    const auto us = hn::NearestInt(hn::Mul(hn::Max(hn::Min(u, one), hn::Neg(one)), largest));
    const auto vs = hn::NearestInt(hn::Mul(hn::Max(hn::Min(v, one), hn::Neg(one)), largest));
    const auto both = hn::Or(hn::ShiftLeft<16>(vs), hn::And(us, hn::Set(di, 0xFFFF)));
    const auto bits = hn::IfThenElse(hn::RebindMask(di, is_none), hn::Set(di, PackedNormal::kNone), both);
    alignas(64) std::array<std::int32_t, SurfaceRow::kLanes> lanes;
    hn::Store(bits, di, lanes.data());
    const int count = std::min(row.width - i, static_cast<int>(hn::Lanes(d)));
    std::memcpy(packed + i, lanes.data(), static_cast<std::size_t>(count) * sizeof(std::int32_t));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse {
namespace {

HWY_EXPORT(analysePinholeRow);
HWY_EXPORT(packRow);

}  // namespace

PaddedDepth::PaddedDepth(const Image<float>& depth, int begin, int end)
    : begin_(begin),
      depth_(depth.width() + 2 * kRadius + SurfaceRow::kLanes, end - begin + 2 * kRadius),
      inverse_(depth_) {
  for (int y = std::max(begin - kRadius, 0); y < std::min(end + kRadius, depth.height()); ++y) {
    const float* row = depth.row(y);
    const int place = y - begin + kRadius;
    std::copy_n(row, depth.width(), depth_.row(place) + kRadius);
    std::transform(row, row + depth.width(), inverse_.row(place) + kRadius,
                   [](float d) { return d > 0 ? 1.0f / d : 0.0f; });
  }
}

void analyseRow(const PinholeSurface& surface, const PaddedDepth& depth, int y, SurfaceRow& row) {
  HWY_DYNAMIC_DISPATCH(analysePinholeRow)(surface, depth, y, row);
}

void packNormals(const SurfaceRow& row, PackedNormal* packed) {
  HWY_DYNAMIC_DISPATCH(packRow)(row, &packed->bits);
}

}  // namespace vdbfuse
#endif
