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

// What pixels with a single hypothesis and a flat depth prior say of points on their rays.
class SingleHypothesis {
 public:
  SingleHypothesis(const PreparedView& view, const LikelihoodRatio& ratio)
      : ratio_(ratio),
        noise_bound_(view.noise),
        cdf_(ratio.table(), -LikelihoodRatio::kReach, LikelihoodRatio::kSteps / (2 * LikelihoodRatio::kReach),
             LikelihoodRatio::kSteps),
        noise_(view.noise.values(), view.noise.near(), view.noise.perStep(), NoiseTable::kSteps) {}

  // L as a fraction.
  struct Fraction {
    FloatVec above, below;
  };

  // `depth` is clamped to the range; `measured` is 0 where nothing was, and the fraction is arbitrary there.
  Fraction operator()(FloatVec measured, FloatVec outlier, FloatVec depth) const {
    const Floats df;
    const FloatVec t = hn::Mul(hn::Sub(depth, hn::Set(df, ratio_.near())), hn::Set(df, ratio_.perRange()));
    const float furthest = hn::GetLane(hn::MaxOfLanes(df, measured));
    const FloatVec reach = hn::Set(df, ratio_.reach() * noise_bound_.boundUpTo(furthest));
    const auto missing = hn::Le(measured, hn::Zero(df));
    const auto inner = hn::Or(missing, hn::And(hn::Gt(hn::Sub(measured, hn::Set(df, ratio_.near())), reach),
                                               hn::Gt(hn::Sub(hn::Set(df, ratio_.far()), measured), reach)));
    const bool is_inner = hn::AllTrue(df, inner);
    const auto clear = hn::Or(missing, hn::Gt(hn::Abs(hn::Sub(depth, measured)), reach));
    if (is_inner && hn::AllTrue(df, clear)) return clearly(measured, outlier, depth, t);
    return closely(measured, outlier, depth, t, is_inner);
  }

 private:
  // Far from its measurement a point is before or behind it whatever the noise: F is 0 or 1.
  Fraction clearly(FloatVec measured, FloatVec outlier, FloatVec depth, FloatVec t) const {
    const Floats df;
    const FloatVec one = hn::Set(df, 1.0f);
    const FloatVec nearer = hn::Mul(outlier, t), further = hn::Sub(outlier, nearer);
    const auto is_behind = hn::Gt(depth, measured);
    return {hn::IfThenElse(is_behind, nearer, hn::Sub(one, nearer)),
            hn::IfThenElse(is_behind, hn::Sub(one, further), further)};
  }

  // `is_inner`: no measurement lies so near to an end of the range that its edge is felt.
  Fraction closely(FloatVec measured, FloatVec outlier, FloatVec depth, FloatVec t, bool is_inner) const {
    const Floats df;
    const FloatVec one = hn::Set(df, 1.0f), zero = hn::Zero(df);
    const FloatVec per_noise = hn::Div(one, noise_(measured));
    const auto cdf = [&](FloatVec d) { return cdf_(hn::Mul(hn::Sub(d, measured), per_noise)); };
    const FloatVec before = cdf(depth);
    const FloatVec below = is_inner ? zero : cdf(hn::Set(df, ratio_.near()));
    const FloatVec above = is_inner ? one : cdf(hn::Set(df, ratio_.far()));
    const FloatVec inlier = hn::Sub(one, outlier), rest = hn::Sub(one, t);
    const FloatVec a = hn::MulAdd(inlier, hn::Max(hn::Sub(above, before), zero), hn::Mul(outlier, rest));
    const FloatVec b = hn::MulAdd(inlier, hn::Max(hn::Sub(before, below), zero), hn::Mul(outlier, t));
    return {hn::Mul(a, t), hn::Mul(b, rest)};
  }

  const LikelihoodRatio& ratio_;
  const NoiseTable& noise_bound_;
  Table cdf_, noise_;
};

void testifySingle(const PreparedView& view, const LikelihoodRatio& ratio, float thickness,
                   const BlockLook& look, std::size_t size, BlockTestimony& testimony) {
  const Floats df;
  const Ints di;
  const float* depths = view.view->depth.data();
  const float* outliers = view.view->outlier.data();
  const SingleHypothesis likelihood(view, ratio);
  const FloatVec first = hn::Set(df, ratio.clampDepth(ratio.near())),
                 last = hn::Set(df, ratio.clampDepth(ratio.far()));
  const FloatVec one = hn::Set(df, 1.0f), zero = hn::Zero(df);
  const FloatVec per_thickness = hn::Set(df, thickness > 0 ? 1 / thickness : 0.0f);
  for (std::size_t i = 0; i < size; i += hn::Lanes(df)) {
    const IntVec pixel = hn::Load(di, &look.pixel[i]);
    const auto seen = hn::RebindMask(df, hn::Gt(pixel, hn::Set(di, -1)));
    const IntVec place = hn::Max(pixel, hn::Zero(di));
    const FloatVec measured = hn::IfThenElseZero(seen, hn::GatherIndex(df, depths, place));
    const auto valid = hn::Gt(measured, zero);
    if (hn::AllFalse(df, valid)) {
      hn::Store(zero, df, &testimony.log_ratio[i]);
      hn::Store(zero, df, &testimony.share[i]);
      continue;
    }
    const FloatVec outlier = hn::GatherIndex(df, outliers, place);
    const FloatVec depth = hn::Min(hn::Max(hn::Load(df, &look.depth[i]), first), last);
    const auto odds = likelihood(measured, outlier, depth);
    hn::Store(hn::IfThenElseZero(valid, hn::Log(df, hn::Div(odds.above, odds.below))), df,
              &testimony.log_ratio[i]);
    const FloatVec behind = hn::Sub(depth, measured);
    const bool whole = thickness <= 0 || hn::AllTrue(df, hn::Lt(behind, zero));
    hn::Store(hn::IfThenElseZero(valid, whole ? one : nearness(behind, per_thickness)), df,
              &testimony.share[i]);
  }
}

FloatVec varianceAt(const LookupVariance& v, FloatVec depth) {
  const auto set = [](float value) HWY_ATTR { return hn::Set(Floats(), value); };
  const NoiseCurve& n = v.noise;
  const FloatVec d = hn::Max(depth, set(n.vertex));
  const FloatVec noise = hn::MulAdd(d, hn::MulAdd(d, set(n.quadratic), set(n.linear)), set(n.constant));
  const FloatVec slack = hn::MulAdd(depth, hn::MulAdd(depth, set(v.slack2), set(v.slack1)), set(v.slack0));
  return hn::MulAdd(noise, noise, slack);
}

void compareDepths(const float* measurements, const LookupVariance& variance, float sigmas,
                   const float* noise, const BlockLook& look, std::size_t size, BlockComparison& comparison) {
  const Floats df;
  const Ints di;
  const FloatVec zero = hn::Zero(df), sigmas_squared = hn::Set(df, sigmas * sigmas);
  const auto word = [&](Measured measured) { return hn::Set(di, static_cast<std::int32_t>(measured)); };
  for (std::size_t i = 0; i < size; i += hn::Lanes(df)) {
    const IntVec pixel = hn::Load(di, &look.pixel[i]);
    const auto seen = hn::Gt(pixel, hn::Set(di, -1));
    if (hn::AllFalse(di, seen)) {
      hn::Store(word(Measured::Unseen), di, &comparison.words[i]);
      continue;
    }
    const FloatVec measured = hn::GatherIndex(df, measurements, hn::Max(pixel, hn::Zero(di)));
    const FloatVec further = hn::Sub(measured, hn::Load(df, &look.depth[i]));
    const FloatVec own = hn::LoadU(df, noise + i);
    const FloatVec limit = hn::Mul(sigmas_squared, hn::MulAdd(own, own, varianceAt(variance, measured)));
    const auto apart = hn::RebindMask(di, hn::Gt(hn::Mul(further, further), limit));
    const IntVec side = hn::IfThenElse(hn::RebindMask(di, hn::Gt(further, zero)), word(Measured::Further),
                                       word(Measured::Nearer));
    const IntVec found = hn::IfThenElse(apart, side, word(Measured::Same));
    const auto nothing = hn::RebindMask(di, hn::Le(measured, zero));
    const IntVec answer = hn::IfThenElse(nothing, word(Measured::Nothing), found);
    hn::Store(hn::IfThenElse(seen, answer, word(Measured::Unseen)), di, &comparison.words[i]);
  }
}

// Not of unit length.
struct Directions {
  FloatVec x, y, z;
};

FloatVec dot(const Directions& a, const Directions& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// PackedNormal::direction().
Directions unpackDirections(IntVec bits) {
  const Floats df;
  const FloatVec one = hn::Set(df, 1.0f), per_unit = hn::Set(df, 1 / PackedNormal::kLargest);
  const FloatVec x = hn::Mul(hn::ConvertTo(df, hn::ShiftRight<16>(hn::ShiftLeft<16>(bits))), per_unit),
                 y = hn::Mul(hn::ConvertTo(df, hn::ShiftRight<16>(bits)), per_unit);
  const FloatVec rest_x = hn::Sub(one, hn::Abs(x)), rest_y = hn::Sub(one, hn::Abs(y));
  const FloatVec z = hn::Sub(rest_x, hn::Abs(y));
  const auto is_folded = hn::Lt(z, hn::Zero(df));
  return {hn::IfThenElse(is_folded, hn::CopySign(rest_y, x), x),
          hn::IfThenElse(is_folded, hn::CopySign(rest_x, y), y), z};
}

void tellNormalsApart(const BlockNormals& normals, const std::int32_t* measured, const BlockLook& look,
                      std::size_t size, BlockComparison& comparison) {
  constexpr float kAgreeCosine = 0.70710678f;  // 45°
  const Floats df;
  const Ints di;
  const FloatVec zero = hn::Zero(df), least = hn::Set(df, kAgreeCosine * kAgreeCosine);
  for (std::size_t i = 0; i < size; i += hn::Lanes(df)) {
    const IntVec said = hn::Load(di, &comparison.words[i]);
    const auto is_same = hn::Eq(said, hn::Set(di, static_cast<std::int32_t>(Measured::Same)));
    if (hn::AllFalse(di, is_same)) continue;
    const IntVec bits = hn::GatherIndex(di, measured, hn::Max(hn::Load(di, &look.pixel[i]), hn::Zero(di)));
    const IntVec own_bits = hn::LoadU(di, &normals[i].bits), none = hn::Set(di, PackedNormal::kNone);
    const Directions own = unpackDirections(own_bits), other = unpackDirections(bits);
    const FloatVec along = dot(own, other), lengths = hn::Mul(dot(own, own), dot(other, other));
    const auto is_turned =
        hn::Or(hn::Lt(along, zero), hn::Lt(hn::Mul(along, along), hn::Mul(least, lengths)));
    const auto is_known = hn::And(hn::Ne(own_bits, none), hn::Ne(bits, none));
    const auto is_other = hn::And(hn::And(is_same, is_known), hn::RebindMask(di, is_turned));
    const IntVec nearer = hn::Set(di, static_cast<std::int32_t>(Measured::Nearer));
    hn::Store(hn::IfThenElse(is_other, nearer, said), di, &comparison.words[i]);
  }
}

void countAnswers(const BlockComparison& comparison, const BlockNormals& normals, const float* sensor,
                  const PointBlock& block, BlockAnswers& answers) {
  constexpr float kFacingCosine = 0.26f;  // 75°
  const Floats df;
  const Ints di;
  const FloatVec zero = hn::Zero(df), least = hn::Set(df, kFacingCosine * kFacingCosine);
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(df)) {
    const IntVec said = hn::Load(di, &comparison.words[i]);
    const auto is = [&](Measured answer)
                        HWY_ATTR { return hn::Eq(said, hn::Set(di, static_cast<std::int32_t>(answer))); };
    // A mask is −1 where it holds.
    const auto add = [&](hn::Mask<Ints> mask, std::int32_t* counts) HWY_ATTR {
      hn::Store(hn::Sub(hn::Load(di, counts), hn::VecFromMask(di, mask)), di, counts);
    };
    add(is(Measured::Same), &answers.agreeing[i]);
    add(is(Measured::Further), &answers.past[i]);
    add(is(Measured::Nothing), &answers.missed[i]);
    const auto is_nearer = is(Measured::Nearer);
    if (hn::AllFalse(di, is_nearer)) continue;
    const Directions to_sensor{hn::Sub(hn::Set(df, sensor[0]), hn::Load(df, &block.x[i])),
                               hn::Sub(hn::Set(df, sensor[1]), hn::Load(df, &block.y[i])),
                               hn::Sub(hn::Set(df, sensor[2]), hn::Load(df, &block.z[i]))};
    const IntVec bits = hn::LoadU(di, &normals[i].bits);
    const Directions normal = unpackDirections(bits);
    const FloatVec along = dot(normal, to_sensor),
                   lengths = hn::Mul(dot(normal, normal), dot(to_sensor, to_sensor));
    const auto faces = hn::And(hn::Gt(along, zero), hn::Gt(hn::Mul(along, along), hn::Mul(least, lengths)));
    const auto may_face = hn::Or(hn::Eq(bits, hn::Set(di, PackedNormal::kNone)), hn::RebindMask(di, faces));
    add(hn::And(is_nearer, may_face), &answers.hidden[i]);
  }
}

void agreeSingle(const PreparedView& view, float voxel, float weight, const BlockLook& look, std::size_t size,
                 float* counts) {
  const Floats df;
  const Ints di;
  const float* depths = view.view->depth.data();
  const float* outliers = view.view->outlier.data();
  const Table noise(view.noise.values(), view.noise.near(), view.noise.perStep(), NoiseTable::kSteps);
  const FloatVec one = hn::Set(df, 1.0f), zero = hn::Zero(df), least = hn::Set(df, voxel);
  for (std::size_t i = 0; i < size; i += hn::Lanes(df)) {
    const IntVec pixel = hn::Load(di, &look.pixel[i]);
    const auto seen = hn::RebindMask(df, hn::Gt(pixel, hn::Set(di, -1)));
    const IntVec place = hn::Max(pixel, hn::Zero(di));
    const FloatVec measured = hn::IfThenElseZero(seen, hn::GatherIndex(df, depths, place));
    const FloatVec distance = hn::Abs(hn::Sub(measured, hn::Load(df, &look.depth[i])));
    const float furthest = hn::GetLane(hn::MaxOfLanes(df, measured));
    const float reach = kAgreementReach * std::max(voxel, view.noise.boundUpTo(furthest));
    auto agrees = hn::And(hn::Gt(measured, zero), hn::Le(distance, hn::Set(df, reach)));
    if (hn::AllFalse(df, agrees)) continue;
    const FloatVec r = hn::Div(distance, hn::Max(least, noise(measured)));
    agrees = hn::And(agrees, hn::Le(r, hn::Set(df, kAgreementReach)));
    const FloatVec reliability = hn::Sub(one, hn::GatherIndex(df, outliers, place));
    const FloatVec kernel = hn::Exp(df, hn::Neg(hn::Mul(r, r)));
    const FloatVec count = hn::Mul(hn::Mul(hn::Set(df, weight), reliability), kernel);
    hn::Store(hn::Add(hn::Load(df, counts + i), hn::IfThenElseZero(agrees, count)), df, counts + i);
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
  alignas(64) std::array<float, PointBlock::kCapacity> peaks, totals;
  for (std::size_t i = 0; i < size; ++i, sums += nodes) {
    auto largest = hn::LoadU(d, sums);
    for (std::size_t k = hn::Lanes(d); k < nodes; k += hn::Lanes(d))
      largest = hn::Max(largest, hn::LoadU(d, sums + k));
    largest = hn::MaxOfLanes(d, largest);
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < nodes; k += hn::Lanes(d))
      sum = hn::Add(sum, hn::Exp(d, hn::Sub(hn::LoadU(d, sums + k), largest)));
    peaks[i] = hn::GetLane(largest), totals[i] = hn::GetLane(hn::SumOfLanes(d, sum));
  }
  std::fill(peaks.begin() + static_cast<std::ptrdiff_t>(size), peaks.end(), 0.0f);
  std::fill(totals.begin() + static_cast<std::ptrdiff_t>(size), totals.end(), 1.0f);
  const auto share = hn::Set(d, 1.0f / static_cast<float>(nodes));
  for (std::size_t i = 0; i < size; i += hn::Lanes(d))
    hn::Store(hn::Add(hn::Load(d, &peaks[i]), hn::Log(d, hn::Mul(hn::Load(d, &totals[i]), share))), d,
              &peaks[i]);
  std::copy_n(peaks.begin(), size, out);
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
HWY_EXPORT(agreeSingle);
HWY_EXPORT(compareDepths);
HWY_EXPORT(tellNormalsApart);
HWY_EXPORT(countAnswers);
HWY_EXPORT(accumulateNodes);
HWY_EXPORT(logMeansOfNodes);
HWY_EXPORT(targetName);

// Any projection, a point at a time.
void lookAny(const Projector& projector, const PointBlock& block, BlockLook& look) {
  for (std::size_t i = 0; i < block.size; ++i) {
    const std::optional<Sighting> seen = projector(block.point(i));
    look.pixel[i] = seen ? seen->y * projector.width() + seen->x : -1;
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

void agreeAny(const PreparedView& prepared, float voxel, float weight, const BlockLook& look,
              std::size_t size, float* counts) {
  const JudgedView& view = *prepared.view;
  for (std::size_t k = 0; k < size; ++k) {
    if (look.pixel[k] < 0) continue;
    const std::size_t pixel = static_cast<std::size_t>(look.pixel[k]);
    if (view.depth.data()[pixel] == kInvalidDepth) continue;
    float kernels = 0;
    forEachHypothesis(prepared, pixel, [&](float depth, float share) {
      const float r = std::abs(depth - look.depth[k]) / std::max(voxel, prepared.noise.at(depth));
      if (r <= kAgreementReach) kernels += share * std::exp(-r * r);
    });
    counts[k] += weight * (1.0f - view.outlier.data()[pixel]) * kernels;
  }
}

}  // namespace

BlockLook look(const Projector& projector, const PointBlock& block) {
  BlockLook result;
  if (const std::optional<PinholeRows> rows = projector.rowsFrom(block.origin)) {
    HWY_DYNAMIC_DISPATCH(lookPinhole)(*rows, block, result);
    // Vectors reach past the last point.
    return result;
  }
  lookAny(projector, block, result);
  std::fill(result.pixel.begin() + static_cast<std::ptrdiff_t>(block.size), result.pixel.end(), -1);
  return result;
}

void prefetch(const float* image, const BlockLook& look, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) __builtin_prefetch(image + std::max(look.pixel[i], 0));
}

void prefetchLines(std::initializer_list<const void*> images, const BlockLook& look, std::size_t size) {
  constexpr std::int32_t kLine = 16;  // pixels of a line of the cache
  std::int32_t last = -1;
  for (std::size_t i = 0; i < size; ++i) {
    const std::int32_t line = look.pixel[i] / kLine;
    if (line == last || look.pixel[i] < 0) continue;
    last = line;
    for (const void* image : images)
      __builtin_prefetch(static_cast<const char*>(image) + 4 * std::ptrdiff_t{look.pixel[i]});
  }
}

BlockLook look(const PreparedView& view, const PointBlock& block) {
  const BlockLook result = look(view.projector, block);
  prefetch(view.view->depth.data(), result, block.size);
  prefetch(view.view->outlier.data(), result, block.size);
  return result;
}

void agree(const PreparedView& view, float voxel, float weight, const BlockLook& look, std::size_t size,
           float* counts) {
  if (view.view->alternatives.empty()) {
    HWY_DYNAMIC_DISPATCH(agreeSingle)(view, voxel, weight, look, size, counts);
  } else {
    agreeAny(view, voxel, weight, look, size, counts);
  }
}

BlockComparison compare(const float* measurements, const LookupVariance& variance, float sigmas,
                        const float* noise, const BlockLook& look, std::size_t size) {
  BlockComparison result;
  HWY_DYNAMIC_DISPATCH(compareDepths)(measurements, variance, sigmas, noise, look, size, result);
  return result;
}

void tellSidesApart(const BlockNormals& normals, const PackedNormal* measured, const BlockLook& look,
                    std::size_t size, BlockComparison& comparison) {
  HWY_DYNAMIC_DISPATCH(tellNormalsApart)(normals, &measured->bits, look, size, comparison);
}

void count(const BlockComparison& comparison, const BlockNormals& normals, const Eigen::Vector3d& sensor,
           const PointBlock& block, BlockAnswers& answers) {
  const Eigen::Vector3f relative = (sensor - block.origin).cast<float>();
  HWY_DYNAMIC_DISPATCH(countAnswers)(comparison, normals, relative.data(), block, answers);
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
