// SPDX-License-Identifier: Apache-2.0
#include "fusion/block_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fusion/block_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;

void lookPinhole(const PinholeRows& camera, const PointBlock& block, BlockLook& look) {
  const Floats df;
  const Ints di;
  const auto row = [&](int r, FloatVec x, FloatVec y, FloatVec z) {
    const float* m = camera.rows[static_cast<std::size_t>(r)].data();
    return hn::MulAdd(hn::Set(df, m[0]), x,
                      hn::MulAdd(hn::Set(df, m[1]), y, hn::MulAdd(hn::Set(df, m[2]), z, hn::Set(df, m[3]))));
  };
  const FloatVec half = hn::Set(df, 0.5f), low = hn::Set(df, -0.5f);
  const FloatVec right = hn::Set(df, static_cast<float>(camera.width) - 0.5f);
  const FloatVec bottom = hn::Set(df, static_cast<float>(camera.height) - 0.5f);
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(df)) {
    const FloatVec x = hn::Load(df, &block.x[i]), y = hn::Load(df, &block.y[i]),
                   z = hn::Load(df, &block.z[i]);
    const FloatVec depth = row(2, x, y, z);
    const FloatVec inverse = hn::Div(hn::Set(df, 1.0f), depth);
    // The rows hold the focal length and the principal point already.
    const FloatVec u = hn::Mul(row(0, x, y, z), inverse), v = hn::Mul(row(1, x, y, z), inverse);
    const auto inside = hn::And(hn::And(hn::Gt(depth, hn::Zero(df)), hn::And(hn::Ge(u, low), hn::Ge(v, low))),
                                hn::And(hn::Lt(u, right), hn::Lt(v, bottom)));
    const FloatVec us = hn::IfThenElseZero(inside, hn::Add(u, half));
    const FloatVec vs = hn::IfThenElseZero(inside, hn::Add(v, half));
    // Rounding up may reach the next column.
    const IntVec column = hn::Min(hn::ConvertTo(di, us), hn::Set(di, camera.width - 1));
    const IntVec line = hn::Min(hn::ConvertTo(di, vs), hn::Set(di, camera.height - 1));
    const IntVec pixel = hn::Add(hn::Mul(line, hn::Set(di, camera.width)), column);
    hn::Store(hn::IfThenElse(hn::RebindMask(di, inside), pixel, hn::Set(di, -1)), di, &look.pixel[i]);
    hn::Store(depth, df, &look.depth[i]);
  }
}

// A function tabulated at equal steps, interpolated.
class Table {
 public:
  Table(const float* values, float first, float per_step, int steps)
      : values_(values), first_(first), per_step_(per_step), last_(static_cast<float>(steps) - 0.001f) {}

  FloatVec operator()(FloatVec x) const {
    const Floats df;
    const Ints di;
    const FloatVec place =
        hn::Min(hn::Max(hn::Mul(hn::Sub(x, hn::Set(df, first_)), hn::Set(df, per_step_)), hn::Zero(df)),
                hn::Set(df, last_));
    const IntVec i = hn::ConvertTo(di, place);
    const FloatVec f = hn::Sub(place, hn::ConvertTo(df, i));
    const FloatVec low = hn::GatherIndex(df, values_, i), high = hn::GatherIndex(df, values_ + 1, i);
    return hn::MulAdd(f, hn::Sub(high, low), low);
  }

 private:
  const float* values_;
  float first_, per_step_, last_;
};

// e^(−(δ/τ)²) behind, 1 before.
FloatVec nearness(FloatVec behind, FloatVec per_thickness) {
  const Floats df;
  const FloatVec far = hn::Mul(hn::Max(behind, hn::Zero(df)), per_thickness);
  return hn::Exp(df, hn::Neg(hn::Mul(far, far)));
}

void testifySingle(const PreparedView& view, const LikelihoodRatio& ratio, float thickness,
                   const BlockLook& look, std::size_t size, BlockTestimony& testimony) {
  const Floats df;
  const Ints di;
  const float* depths = view.view->depth.data();
  const float* outliers = view.view->outlier.data();
  constexpr float kReach = LikelihoodRatio::kReach;
  const Table cdf(ratio.table(), -kReach, LikelihoodRatio::kSteps / (2 * kReach), LikelihoodRatio::kSteps);
  const Table noise(view.noise.values(), view.noise.near(), view.noise.perStep(), NoiseTable::kSteps);
  const FloatVec near = hn::Set(df, ratio.near()), far = hn::Set(df, ratio.far());
  const FloatVec first = hn::Set(df, ratio.clampDepth(ratio.near())),
                 last = hn::Set(df, ratio.clampDepth(ratio.far()));
  const FloatVec one = hn::Set(df, 1.0f), zero = hn::Zero(df), reach = hn::Set(df, kReach);
  const FloatVec per_thickness = hn::Set(df, thickness > 0 ? 1 / thickness : 0.0f);
  for (std::size_t i = 0; i < size; i += hn::Lanes(df)) {
    const IntVec pixel = hn::Load(di, &look.pixel[i]);
    const FloatVec found = hn::GatherIndex(df, depths, hn::Max(pixel, hn::Zero(di)));
    const auto valid = hn::And(hn::RebindMask(df, hn::Gt(pixel, hn::Set(di, -1))), hn::Gt(found, zero));
    if (hn::AllFalse(df, valid)) {
      hn::Store(zero, df, &testimony.log_ratio[i]);
      hn::Store(zero, df, &testimony.share[i]);
      continue;
    }
    const FloatVec measured = hn::IfThenElse(valid, found, far);
    const FloatVec outlier = hn::GatherIndex(df, outliers, hn::Max(pixel, hn::Zero(di)));
    const FloatVec inlier = hn::Sub(one, outlier);
    const FloatVec per_noise = hn::Div(one, noise(measured));
    const FloatVec depth = hn::Min(hn::Max(hn::Load(df, &look.depth[i]), first), last);
    const FloatVec t = hn::Mul(hn::Sub(depth, near), hn::Set(df, ratio.perRange()));
    const FloatVec before = cdf(hn::Mul(hn::Sub(depth, measured), per_noise));
    const FloatVec start = hn::Mul(hn::Sub(measured, near), per_noise);
    const FloatVec end = hn::Mul(hn::Sub(far, measured), per_noise);
    // Few measurements lie so near to an end of the range that its edge is felt.
    const bool felt =
        !hn::AllTrue(df, hn::Or(hn::Not(valid), hn::And(hn::Gt(start, reach), hn::Gt(end, reach))));
    const FloatVec below = felt ? cdf(hn::Neg(start)) : zero, above = felt ? cdf(end) : one;
    const FloatVec rest = hn::Sub(one, t);
    const FloatVec a = hn::MulAdd(inlier, hn::Max(hn::Sub(above, before), zero), hn::Mul(outlier, rest));
    const FloatVec b = hn::MulAdd(inlier, hn::Max(hn::Sub(before, below), zero), hn::Mul(outlier, t));
    const FloatVec odds = hn::Div(hn::Mul(a, t), hn::Mul(b, rest));
    hn::Store(hn::IfThenElseZero(valid, hn::Log(df, odds)), df, &testimony.log_ratio[i]);
    const FloatVec behind = hn::Sub(depth, measured);
    const bool whole = thickness <= 0 || hn::AllTrue(df, hn::Lt(behind, zero));
    hn::Store(hn::IfThenElseZero(valid, whole ? one : nearness(behind, per_thickness)), df,
              &testimony.share[i]);
  }
}

void accumulateNodes(const VisibilityIntegral& integral, const BlockTestimony& testimony, float weight,
                     std::size_t size, float* sums) {
  const hn::CappedTag<float, 8> d;
  const std::size_t nodes = static_cast<std::size_t>(integral.nodeCount());
  for (std::size_t i = 0; i < size; ++i, sums += nodes) {
    const float w = weight * testimony.share[i];
    if (w == 0) continue;
    const VisibilityIntegral::Row row = integral.rowOf(testimony.log_ratio[i]);
    const auto f = hn::Set(d, row.share), factor = hn::Set(d, w);
    for (std::size_t k = 0; k < nodes; k += hn::Lanes(d)) {
      const auto low = hn::LoadU(d, row.low + k), high = hn::LoadU(d, row.high + k);
      const auto term = hn::MulAdd(f, hn::Sub(high, low), low);
      hn::StoreU(hn::MulAdd(factor, term, hn::LoadU(d, sums + k)), d, sums + k);
    }
  }
}

void logMeansOfNodes(const VisibilityIntegral& integral, const float* sums, std::size_t size, float* out) {
  const hn::CappedTag<float, 8> d;
  const std::size_t nodes = static_cast<std::size_t>(integral.nodeCount());
  for (std::size_t i = 0; i < size; ++i, sums += nodes) {
    auto largest = hn::LoadU(d, sums);
    for (std::size_t k = hn::Lanes(d); k < nodes; k += hn::Lanes(d))
      largest = hn::Max(largest, hn::LoadU(d, sums + k));
    largest = hn::MaxOfLanes(d, largest);
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < nodes; k += hn::Lanes(d))
      sum = hn::Add(sum, hn::Exp(d, hn::Sub(hn::LoadU(d, sums + k), largest)));
    out[i] = hn::GetLane(largest) + std::log(hn::GetLane(hn::SumOfLanes(d, sum)) / static_cast<float>(nodes));
  }
}

const char* targetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse {
namespace {

HWY_EXPORT(lookPinhole);
HWY_EXPORT(testifySingle);
HWY_EXPORT(accumulateNodes);
HWY_EXPORT(logMeansOfNodes);
HWY_EXPORT(targetName);

// Any projection, a point at a time.
void lookAny(const PreparedView& view, const PointBlock& block, BlockLook& look) {
  for (std::size_t i = 0; i < block.size; ++i) {
    const std::optional<Sighting> seen = view.projector(block.point(i));
    look.pixel[i] = seen ? seen->y * view.view->depth.width() + seen->x : -1;
    look.depth[i] = seen ? static_cast<float>(seen->depth) : 0.0f;
  }
}

// Several hypotheses, or a depth prior that is not flat.
void testifyAny(const PreparedView& prepared, const LikelihoodRatio& ratio, float thickness,
                const BlockLook& look, std::size_t size, BlockTestimony& testimony) {
  const float per_thickness = thickness > 0 ? 1 / thickness : 0.0f;
  const JudgedView& view = *prepared.view;
  for (std::size_t i = 0; i < size; ++i) {
    testimony.log_ratio[i] = testimony.share[i] = 0.0f;
    if (look.pixel[i] < 0) continue;
    const std::size_t pixel = static_cast<std::size_t>(look.pixel[i]);
    if (view.depth.data()[pixel] == kInvalidDepth) continue;
    const float depth = ratio.clampDepth(look.depth[i]);
    LikelihoodRatio::Odds odds;
    forEachHypothesis(prepared, pixel, [&](float measured, float share) {
      ratio.add({measured, prepared.noise.at(measured), share}, depth, odds);
    });
    testimony.log_ratio[i] = ratio.combine(odds, view.outlier.data()[pixel], depth);
    const float behind = std::max(depth - view.depth.data()[pixel], 0.0f) * per_thickness;
    testimony.share[i] = std::exp(-behind * behind);
  }
}

}  // namespace

BlockLook look(const PreparedView& view, const PointBlock& block) {
  BlockLook result;
  if (const std::optional<PinholeRows> rows = view.projector.rowsFrom(block.origin)) {
    HWY_DYNAMIC_DISPATCH(lookPinhole)(*rows, block, result);
    // Vectors reach past the last point.
    return result;
  }
  lookAny(view, block, result);
  std::fill(result.pixel.begin() + static_cast<std::ptrdiff_t>(block.size), result.pixel.end(), -1);
  return result;
}

BlockTestimony testify(const PreparedView& view, const LikelihoodRatio& ratio, float thickness,
                       const BlockLook& look, std::size_t size) {
  BlockTestimony result;
  if (view.view->alternatives.empty() && !ratio.thick()) {
    HWY_DYNAMIC_DISPATCH(testifySingle)(view, ratio, thickness, look, size, result);
  } else {
    testifyAny(view, ratio, thickness, look, size, result);
  }
  return result;
}

void accumulate(const VisibilityIntegral& integral, const BlockTestimony& testimony, float weight,
                std::size_t size, float* sums) {
  if (integral.nodeCount() % 8 == 0) {
    HWY_DYNAMIC_DISPATCH(accumulateNodes)(integral, testimony, weight, size, sums);
    return;
  }
  for (std::size_t i = 0; i < size; ++i, sums += integral.nodeCount())
    if (testimony.share[i] != 0) integral.add(testimony.log_ratio[i], weight, sums);
}

void logMeans(const VisibilityIntegral& integral, const float* sums, std::size_t size, float* out) {
  if (integral.nodeCount() % 8 == 0) {
    HWY_DYNAMIC_DISPATCH(logMeansOfNodes)(integral, sums, size, out);
    return;
  }
  for (std::size_t i = 0; i < size; ++i, sums += integral.nodeCount())
    out[i] = static_cast<float>(integral.logMean(sums));
}

const char* simdTarget() { return HWY_DYNAMIC_DISPATCH(targetName)(); }

}  // namespace vdbfuse
#endif
