// SPDX-License-Identifier: Apache-2.0
#include "stereo/sweep_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/sweep_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse::stereo {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kVectorLanes>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
using FloatMask = hn::Mask<Floats>;

HWY_INLINE FloatVec set(float value) { return hn::Set(Floats(), value); }
HWY_INLINE IntVec set(int value) { return hn::Set(Ints(), value); }

// Of each 32-bit lane: low·low + high·high of its 16-bit halves.
HWY_INLINE IntVec pairProducts(IntVec a, IntVec b) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  const Ints d;
  const hn::Repartition<std::int16_t, Ints> d16;
  IntVec unused = hn::Zero(d);
  return hn::ReorderWidenMulAccumulate(d, hn::BitCast(d16, a), hn::BitCast(d16, b), hn::Zero(d), unused);
#else
  const auto low = [](IntVec x) HWY_ATTR { return hn::ShiftRight<16>(hn::ShiftLeft<16>(x)); };
  const auto high = [](IntVec x) HWY_ATTR { return hn::ShiftRight<16>(x); };
  return hn::Add(hn::Mul(low(a), low(b)), hn::Mul(high(a), high(b)));
#endif
}

// 256 − f for the first and f for the second of a pair.
HWY_INLINE IntVec pairWeights(IntVec f) { return hn::Add(hn::Sub(hn::ShiftLeft<16>(f), f), set(256)); }

// One row of a partner's picture as the reference would see it, in three passes: where its pixels come from,
// their texels (one load each beats the gathers of some processors), and what lies between them.
class Warp {
 public:
  Warp(const PictureLevel& partner, const ImageMotion& motion, float offset, int radius, SweepMemory& memory)
      : quads_(partner.quads.data()),
        mask_(partner.mask.empty() ? nullptr : partner.mask.data()),
        motion_(motion),
        memory_(memory),
        stride_(partner.quads.width()),
        margin_(static_cast<float>(radius)),
        right_(static_cast<float>(partner.camera.width - 1)),
        bottom_(static_cast<float>(partner.camera.height - 1)) {
    for (std::size_t i = 0; i < 3; ++i) motion_.a[3 * i + 2] += offset * motion.b[i];
  }

  // Values into `value`, and all bits of `valid` where the pixel and a window around it lie in the picture.
  HWY_INLINE void row(float x, float y, const float* base, std::size_t count, std::int32_t* value,
                      std::int32_t* valid) const {
    locate(x, y, base, count, valid);
    const std::int32_t* index = memory_.index.data();
    if (mask_ != nullptr) applyMask(index, count, valid);
    auto* texels = reinterpret_cast<std::byte*>(memory_.texels.data());
    for (std::size_t i = 0; i < count; i += 4) {
      std::memcpy(texels + 8 * i, quads_ + index[i], 8);
      std::memcpy(texels + 8 * i + 8, quads_ + index[i + 1], 8);
      std::memcpy(texels + 8 * i + 16, quads_ + index[i + 2], 8);
      std::memcpy(texels + 8 * i + 24, quads_ + index[i + 3], 8);
    }
    interpolate(count, value);
  }

 private:
  HWY_INLINE void locate(float x, float y, const float* base, std::size_t count, std::int32_t* valid) const {
    const Floats d;
    const auto& a = motion_.a;
    const auto& b = motion_.b;
    const FloatVec x_lanes = hn::Iota(d, x);
    const float start[3] = {a[1] * y + a[2], a[4] * y + a[5], a[7] * y + a[8]};
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const FloatVec column = hn::Add(x_lanes, set(static_cast<float>(i)));
      const FloatVec w = hn::Load(d, base + i);
      const auto coordinate = [&](std::size_t r) HWY_ATTR {
        return hn::MulAdd(w, set(b[r]), hn::MulAdd(column, set(a[3 * r]), set(start[r])));
      };
      const FloatVec z = coordinate(2), inverse = hn::Div(set(1.0F), z);
      place(hn::Mul(coordinate(0), inverse), hn::Mul(coordinate(1), inverse), hn::Gt(z, set(0.0F)), i,
            valid + i);
    }
  }

  HWY_INLINE void place(FloatVec u, FloatVec v, FloatMask before, std::size_t i, std::int32_t* valid) const {
    const Ints di;
    const auto inside = hn::And(hn::And(before, hn::And(hn::Ge(u, set(margin_)), hn::Ge(v, set(margin_)))),
                                hn::And(hn::Le(u, set(right_ - margin_)), hn::Le(v, set(bottom_ - margin_))));
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, inside)), di, valid);
    const auto fixed = [&](FloatVec c, float last) HWY_ATTR {
      const FloatVec clamped = hn::Min(hn::Max(c, set(0.0F)), set(last));
      return hn::ConvertTo(di, hn::MulAdd(hn::IfThenElseZero(before, clamped), set(256.0F), set(0.5F)));
    };
    const IntVec fu = fixed(u, right_), fv = fixed(v, bottom_);
    hn::Store(hn::Add(hn::Mul(hn::ShiftRight<8>(fv), set(stride_)), hn::ShiftRight<8>(fu)), di,
              memory_.index.data() + i);
    hn::Store(pairWeights(hn::And(fu, set(255))), di, memory_.weights.data() + 2 * i);
    hn::Store(pairWeights(hn::And(fv, set(255))), di, memory_.weights.data() + 2 * i + hn::Lanes(di));
  }

  HWY_INLINE void interpolate(std::size_t count, std::int32_t* value) const {
    const Ints di;
    for (std::size_t i = 0; i < count; i += hn::Lanes(di)) {
      IntVec top, bottom;
      hn::LoadInterleaved2(di, memory_.texels.data() + 2 * i, top, bottom);
      const IntVec wu = hn::Load(di, memory_.weights.data() + 2 * i);
      const IntVec wv = hn::Load(di, memory_.weights.data() + 2 * i + hn::Lanes(di));
      const IntVec upper = hn::ShiftRight<5>(pairProducts(top, wu));
      const IntVec lower = hn::ShiftRight<5>(pairProducts(bottom, wu));
      const IntVec both = hn::Or(upper, hn::ShiftLeft<16>(lower));
      hn::Store(hn::ShiftRight<11>(hn::Add(pairProducts(both, wv), set(1024))), di, value + i);
    }
  }

  void applyMask(const std::int32_t* index, std::size_t count, std::int32_t* valid) const {
    for (std::size_t i = 0; i < count; ++i)
      if (mask_[index[i]] == 0) valid[i] = 0;
  }

  const std::uint64_t* quads_;
  const std::uint8_t* mask_;
  ImageMotion motion_;
  SweepMemory& memory_;
  int stride_;
  float margin_, right_, bottom_;
};

// Running sums down the columns of v, v² and u·v over the last `window` rows.
HWY_INLINE void addRow(const std::int32_t* value, const std::int32_t* products, std::size_t count,
                       std::size_t stride, std::int32_t* oldest, std::int32_t* columns) {
  const Ints d;
  const auto add = [&](std::int32_t* sum, IntVec x)
                       HWY_ATTR { hn::Store(hn::Add(hn::Load(d, sum), x), d, sum); };
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const IntVec v = hn::Load(d, value + i), old = hn::ShiftLeft<16>(hn::Load(d, oldest + i));
    const IntVec with_old = hn::Or(v, old);
    add(columns + i, hn::Sub(v, hn::ShiftRight<16>(old)));
    add(columns + stride + i, pairProducts(with_old, hn::Sub(v, old)));
    add(columns + 2 * stride + i, pairProducts(with_old, hn::Load(d, products + i)));
    hn::Store(v, d, oldest + i);
  }
}

// Σ of 2r + 1 neighbours from x on.
HWY_INLINE IntVec windowSum(const std::int32_t* from, int window) {
  const Ints d;
  IntVec sum = hn::Load(d, from);
  for (int k = 1; k < window; ++k) sum = hn::Add(sum, hn::LoadU(d, from + k));
  return sum;
}

HWY_INLINE IntVec windowSum7(const std::int32_t* from) {
  const Ints d;
  const IntVec a = hn::Add(hn::Load(d, from), hn::LoadU(d, from + 1));
  const IntVec b = hn::Add(hn::LoadU(d, from + 2), hn::LoadU(d, from + 3));
  const IntVec c = hn::Add(hn::LoadU(d, from + 4), hn::LoadU(d, from + 5));
  return hn::Add(hn::Add(a, b), hn::Add(c, hn::LoadU(d, from + 6)));
}

// Correlations of one row of windows, at the lanes from i on.
struct RowOfWindows {
  const std::int32_t* columns;
  const std::int32_t* valid;
  const float* mean;
  const float* inverse_spread;
  std::size_t stride;
  int window;
  float share, least_spread2;

  HWY_INLINE FloatVec at(std::size_t i) const {
    const Floats d;
    const Ints di;
    const auto sum = [&](const std::int32_t* from) HWY_ATTR {
      return hn::ConvertTo(d, window == 7 ? windowSum7(from + i) : windowSum(from + i, window));
    };
    const FloatVec v = sum(columns), vv = sum(columns + stride), uv = sum(columns + 2 * stride);
    const FloatVec covariance = hn::NegMulAdd(hn::Load(d, mean + i), v, uv);
    const FloatVec spread2 = hn::NegMulAdd(hn::Mul(v, set(share)), v, vv);
    const FloatVec score = hn::Mul(covariance, hn::Load(d, inverse_spread + i));
    const auto good = hn::And(hn::MaskFromVec(hn::BitCast(d, hn::LoadU(di, valid + i))),
                              hn::Ge(spread2, set(least_spread2)));
    return hn::IfThenElse(good, hn::Div(score, hn::Sqrt(spread2)), set(kNoPeak));
  }
};

// Where a curve has its maximum, from three samples around k.
struct Parabola {
  FloatVec step, score, curvature;
};
HWY_INLINE Parabola parabola(FloatVec before, FloatVec at, FloatVec after, float k) {
  const FloatVec curvature = hn::Sub(hn::Add(at, at), hn::Add(before, after));
  const FloatVec slope = hn::Mul(set(0.5F), hn::Sub(after, before));
  const FloatVec shift = hn::Div(slope, curvature);
  return {hn::Add(set(k), shift), hn::MulAdd(hn::Mul(set(0.5F), shift), slope, at), curvature};
}

class BestSink {
 public:
  BestSink(BestPeaks& peaks) : peaks_(peaks) {}
  HWY_INLINE void put(std::size_t i, FloatMask is_peak, FloatVec before, FloatVec at, FloatVec after,
                      float k) const {
    const Floats d;
    float* score = peaks_.score.data() + i;
    const FloatVec best = hn::Load(d, score);
    const auto better = hn::And(is_peak, hn::Gt(at, best));
    if (hn::AllFalse(d, better)) return;
    const Parabola top = parabola(before, at, after, k);
    const auto keep = [&](FloatVec value, float* to)
                          HWY_ATTR { hn::Store(hn::IfThenElse(better, value, hn::Load(d, to)), d, to); };
    keep(at, score);
    keep(top.step, peaks_.step.data() + i);
    keep(top.curvature, peaks_.curvature.data() + i);
  }

 private:
  BestPeaks& peaks_;
};

class ListSink {
 public:
  ListSink(PeakLists& lists, int index) : lists_(lists), index_(index) {}
  HWY_INLINE void put(std::size_t i, FloatMask is_peak, FloatVec before, FloatVec at, FloatVec after,
                      float k) const {
    const Floats d;
    if (hn::AllFalse(d, is_peak)) return;
    const Parabola top = parabola(before, at, after, k);
    alignas(64) float step[kVectorLanes], score[kVectorLanes], curvature[kVectorLanes];
    hn::Store(top.step, d, step);
    hn::Store(top.curvature, d, curvature);
    hn::Store(hn::IfThenElse(is_peak, at, set(kNoPeak)), d, score);
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
      if (score[lane] != kNoPeak) push(i + lane, {step[lane], score[lane], curvature[lane], index_});
  }

 private:
  void push(std::size_t pixel, const Peak& peak) const {
    const std::size_t list =
        pixel * static_cast<std::size_t>(lists_.partners) + static_cast<std::size_t>(index_);
    std::uint8_t& count = lists_.counts[list];
    Peak* peaks = lists_.peaks.data() + list * kMostPeaks;
    if (count < kMostPeaks) {
      peaks[count++] = peak;
      return;
    }
    Peak* worst = std::min_element(peaks, peaks + kMostPeaks,
                                   [](const Peak& a, const Peak& b) { return a.score < b.score; });
    if (worst->score < peak.score) *worst = peak;
  }
  PeakLists& lists_;
  int index_;
};

// A local maximum lies at the sample before this one where the curve falls now and did not before.
template <class Sink>
HWY_INLINE void lookForPeaks(const RowOfWindows& row, std::size_t from, std::size_t width, float k,
                             float threshold, const float* before, const float* at, float* now,
                             const Sink& sink) {
  const Floats d;
  for (std::size_t i = 0; i < width; i += hn::Lanes(d)) {
    const FloatVec after = row.at(i);
    const FloatVec s0 = hn::Load(d, before + from + i), s1 = hn::Load(d, at + from + i);
    hn::Store(after, d, now + from + i);
    // A sample without a window is no lower neighbour.
    const auto is_peak =
        hn::And(hn::And(hn::Gt(s1, set(threshold)), hn::And(hn::Gt(s1, s0), hn::Ge(s1, after))),
                hn::And(hn::Gt(s0, set(kNoPeak)), hn::Gt(after, set(kNoPeak))));
    sink.put(from + i, is_peak, s0, s1, after, k);
  }
}

template <class Sink>
void sweep(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
           const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, const Sink& sink) {
  const int window = tile.window();
  const auto stride = static_cast<std::size_t>(tile.stride), width = static_cast<std::size_t>(tile.width);
  const auto rows = static_cast<std::size_t>(window);
  // Loads from a row's end may reach beyond it.
  memory.ring.resize((rows + 2) * stride), memory.valid.resize((rows + 2) * stride);
  memory.columns.resize(4 * stride);
  memory.index.resize(stride), memory.weights.resize(2 * stride), memory.texels.resize(2 * stride);
  for (AlignedFloats& curve : memory.curve) curve.assign(tile.at(0, tile.height), kNoPeak);
  std::int32_t* current = memory.ring.data() + rows * stride;
  for (int k = 0; k < range.count; ++k) {
    const Warp warp(partner, motion, range.first + static_cast<float>(k) * range.step, tile.radius, memory);
    std::fill(memory.ring.begin(), memory.ring.end(), 0);
    std::fill(memory.columns.begin(), memory.columns.end(), 0);
    float* now = memory.curve[static_cast<std::size_t>(k % 3)].data();
    const float* at = memory.curve[static_cast<std::size_t>((k + 2) % 3)].data();
    const float* before = memory.curve[static_cast<std::size_t>((k + 1) % 3)].data();
    for (int y = 0; y < tile.height + 2 * tile.radius; ++y) {
      const std::size_t slot = static_cast<std::size_t>(y % window) * stride;
      warp.row(static_cast<float>(tile.x0 - tile.radius), static_cast<float>(tile.y0 - tile.radius + y),
               tile.base.data() + tile.at(0, y), stride, current, memory.valid.data() + slot);
      addRow(current, tile.products.data() + tile.at(0, y), stride, stride, memory.ring.data() + slot,
             memory.columns.data());
      const int line = y - 2 * tile.radius;
      if (line < 0) continue;
      const std::size_t from = tile.at(0, line);
      const std::size_t centre = static_cast<std::size_t>((y - tile.radius) % window) * stride;
      const RowOfWindows windows{memory.columns.data(),
                                 memory.valid.data() + centre + static_cast<std::size_t>(tile.radius),
                                 tile.mean.data() + from,
                                 tile.inverse_spread.data() + from,
                                 stride,
                                 window,
                                 1.0F / static_cast<float>(window * window),
                                 limits.least_spread2};
      lookForPeaks(windows, from, width, static_cast<float>(k - 1), limits.threshold, before, at, now, sink);
    }
  }
}

void sweepBest(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
               const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, BestPeaks& peaks) {
  sweep(tile, partner, motion, range, limits, memory, BestSink(peaks));
}

void sweepAll(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
              const SweepRange& range, const SweepLimits& limits, int index, SweepMemory& memory,
              PeakLists& peaks) {
  sweep(tile, partner, motion, range, limits, memory, ListSink(peaks, index));
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse::stereo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse::stereo {

HWY_EXPORT(sweepBest);
HWY_EXPORT(sweepAll);

ImageMotion imageMotion(const Pinhole& reference, const RigidTransform& world_from_reference,
                        const Pinhole& partner, const RigidTransform& world_from_partner) {
  const RigidTransform partner_from_reference = world_from_partner.inverse() * world_from_reference;
  const auto matrix = [](const Pinhole& c) {
    Eigen::Matrix3d k;
    k << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1;
    return k;
  };
  const Eigen::Matrix3d a = matrix(partner) * partner_from_reference.linear() * matrix(reference).inverse();
  const Eigen::Vector3d b = matrix(partner) * partner_from_reference.translation();
  ImageMotion motion;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) motion.a[static_cast<std::size_t>(3 * r + c)] = static_cast<float>(a(r, c));
    motion.b[static_cast<std::size_t>(r)] = static_cast<float>(b(r));
  }
  return motion;
}

void sweepForBest(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
                  const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, BestPeaks& peaks) {
  const std::size_t size = tile.at(0, tile.height);
  peaks.score.assign(size, kNoPeak);
  peaks.step.resize(size), peaks.curvature.resize(size);
  HWY_DYNAMIC_DISPATCH(sweepBest)(tile, partner, motion, range, limits, memory, peaks);
}

void sweepForAll(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
                 const SweepRange& range, const SweepLimits& limits, int index, SweepMemory& memory,
                 PeakLists& peaks) {
  HWY_DYNAMIC_DISPATCH(sweepAll)(tile, partner, motion, range, limits, index, memory, peaks);
}

}  // namespace vdbfuse::stereo
#endif
