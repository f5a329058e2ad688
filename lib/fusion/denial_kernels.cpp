// SPDX-License-Identifier: Apache-2.0
#include "fusion/denial_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fusion/denial_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;

HWY_INLINE FloatVec number(float value) { return hn::Set(Floats(), value); }
HWY_INLINE IntVec whole(int value) { return hn::Set(Ints(), value); }

// One coordinate of the rays.
struct Axis {
  FloatVec start, pace, per_pace;
  FloatVec ahead;  // kHalf where the coordinate grows, else 0
  int last;        // of the grid's points
};

HWY_INLINE Axis axisOf(const float* start, const float* way, FloatVec per_length, int points) {
  const Floats d;
  constexpr float kStill = 1e-9f;
  const FloatVec pace = hn::Mul(hn::Load(d, way), per_length);
  const FloatVec moving =
      hn::IfThenElse(hn::Lt(hn::Abs(pace), number(kStill)), hn::CopySign(number(kStill), pace), pace);
  const FloatVec ahead = hn::IfThenElseZero(hn::Gt(pace, hn::Zero(d)), number(BrickedEvidence::kHalf));
  return {hn::Load(d, start), moving, hn::Div(number(1), moving), ahead, points - 1};
}

// Narrows the steps between which the rays are inside the grid.
HWY_INLINE void clip(const Axis& axis, FloatVec& first, FloatVec& last) {
  const FloatVec low = hn::Neg(hn::Mul(axis.start, axis.per_pace));
  const FloatVec high =
      hn::Mul(hn::Sub(number(static_cast<float>(axis.last + 1)), axis.start), axis.per_pace);
  first = hn::Max(first, hn::Min(low, high));
  last = hn::Min(last, hn::Max(low, high));
}

// Where the rays are after some steps.
struct Place {
  FloatVec exact;
  IntVec cell;
};

HWY_INLINE Place placeOf(const Axis& axis, FloatVec steps) {
  const Ints di;
  const FloatVec exact = hn::MulAdd(steps, axis.pace, axis.start);
  return {exact, hn::Min(hn::Max(hn::ConvertTo(di, exact), hn::Zero(di)), whole(axis.last))};
}

// Steps until the rays leave the octant along one axis.
HWY_INLINE FloatVec stepsToLeave(const Axis& axis, const Place& place) {
  const Floats d;
  const IntVec low = hn::AndNot(whole(BrickedEvidence::kHalf - 1), place.cell);
  return hn::Mul(hn::Sub(hn::Add(hn::ConvertTo(d, low), axis.ahead), place.exact), axis.per_pace);
}

HWY_INLINE IntVec joined(IntVec x, IntVec y, IntVec z, int a_side_x, int a_side_y) {
  return hn::Add(hn::Mul(hn::Add(hn::Mul(z, whole(a_side_y)), y), whole(a_side_x)), x);
}

HWY_INLINE IntVec bit2(IntVec v) { return hn::And(hn::ShiftRight<2>(v), whole(1)); }
HWY_INLINE IntVec lowBits(IntVec v) { return hn::And(v, whole(BrickedEvidence::kBrick - 1)); }

void march(const BrickedEvidence& evidence, float most, RayBatch& rays) {
  static_assert(BrickedEvidence::kBrick == 8);
  const Floats d;
  const std::array<int, 3>& points = evidence.points_a_side;
  const int bricks_x = points[0] / BrickedEvidence::kBrick, bricks_y = points[1] / BrickedEvidence::kBrick;
  for (std::size_t i = 0; i < rays.size; i += hn::Lanes(d)) {
    const FloatVec x = hn::Load(d, &rays.way[0][i]), y = hn::Load(d, &rays.way[1][i]),
                   z = hn::Load(d, &rays.way[2][i]);
    const FloatVec length = hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z))));
    const FloatVec per_length = hn::Div(number(1), hn::Max(length, number(1e-9f)));
    const Axis ax = axisOf(&rays.start[0][i], &rays.way[0][i], per_length, points[0]),
               ay = axisOf(&rays.start[1][i], &rays.way[1][i], per_length, points[1]),
               az = axisOf(&rays.start[2][i], &rays.way[2][i], per_length, points[2]);
    FloatVec steps = hn::Zero(d), last = length;
    clip(ax, steps, last), clip(ay, steps, last), clip(az, steps, last);
    // In whole steps, so that the same points are met.
    const FloatVec safe = hn::Sub(hn::Mul(hn::Load(d, &rays.safe[i]), length), steps);
    steps = hn::Add(steps, hn::Floor(hn::Max(safe, hn::Zero(d))));
    FloatVec smallest = number(most);
    for (auto active = hn::Le(steps, last); !hn::AllFalse(d, active); active = hn::Le(steps, last)) {
      const Place px = placeOf(ax, steps), py = placeOf(ay, steps), pz = placeOf(az, steps);
      const IntVec brick = joined(hn::ShiftRight<3>(px.cell), hn::ShiftRight<3>(py.cell),
                                  hn::ShiftRight<3>(pz.cell), bricks_x, bricks_y);
      const IntVec octant = joined(bit2(px.cell), bit2(py.cell), bit2(pz.cell), 2, 2);
      const FloatVec here = hn::GatherIndex(d, evidence.smallest, hn::Add(hn::ShiftLeft<3>(brick), octant));
      const auto denies = hn::And(active, hn::Lt(here, smallest));
      FloatVec pace = hn::Min(stepsToLeave(ax, px), hn::Min(stepsToLeave(ay, py), stepsToLeave(az, pz)));
      pace = hn::Max(hn::Ceil(pace), number(1));
      if (!hn::AllFalse(d, denies)) {
        const IntVec point = joined(lowBits(px.cell), lowBits(py.cell), lowBits(pz.cell), 8, 8);
        const FloatVec value = hn::GatherIndex(d, evidence.values, hn::Add(hn::ShiftLeft<9>(brick), point));
        smallest = hn::IfThenElse(denies, hn::Min(smallest, value), smallest);
        pace = hn::IfThenElse(denies, number(1), pace);
      }
      steps = hn::Add(steps, pace);
    }
    hn::Store(smallest, d, &rays.smallest[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse {
namespace {

HWY_EXPORT(march);

}  // namespace

void findSmallest(const BrickedEvidence& evidence, float most, RayBatch& rays) {
  HWY_DYNAMIC_DISPATCH(march)(evidence, most, rays);
}

}  // namespace vdbfuse
#endif
