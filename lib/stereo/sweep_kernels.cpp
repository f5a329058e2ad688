// SPDX-License-Identifier: Apache-2.0
#include "stereo/sweep_kernels.h"

#include "stereo/paper_ray.h"
#include "stereo/sweep_spans.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/sweep_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

#include "stereo/reciprocals-inl.h"

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

// One row of a partner's picture as the reference would see it, in two passes: where its pixels come from,
// and what lies between their texels.
class Warp {
  // Added to a number below it, it makes the last bit of a float mean 1: the float's bits are whole numbers.
  static constexpr float kUnits = 8388608.0F;
  static constexpr std::int32_t kUnitsBits = 0x4B000000;
  static constexpr int kWidest = 32768;        // pixels of a picture; a 256th of one is a unit
  static constexpr float kLeastRatio = 1e-6F;  // of the depths in both pictures: what is nearer lies behind

 public:
  Warp(const PictureLevel& partner, const ImageMotion& motion, float offset, int radius, SweepMemory& memory)
      : quads_(partner.quads.data()),
        mask_(partner.mask.empty() ? nullptr : partner.mask.data()),
        motion_(motion),
        index_(memory.index.data()),
        weights_(memory.weights.data()),
        texels_(memory.texels.data()),
        stride_(partner.quads.width()),
        first_(static_cast<std::int32_t>((kUnitsBits >> 8) * (static_cast<std::uint32_t>(stride_) + 1))),
        margin_(static_cast<float>(radius)),
        right_(static_cast<float>(std::min(partner.camera.width, kWidest) - 1)),
        bottom_(static_cast<float>(std::min(partner.camera.height, kWidest) - 1)) {
    for (std::size_t i = 0; i < 3; ++i) motion_.a[3 * i + 2] += offset * motion.b[i];
  }

  // Fetches the texels of some pixels; `valid` becomes all bits where the pixel and a window around it lie
  // in the picture.
  HWY_INLINE void fetch(float x, float y, const float* base, const Span& span, std::int32_t* valid) const {
    const Floats d;
    const auto& a = motion_.a;
    const float start[3] = {a[1] * y + a[2], a[4] * y + a[5], a[7] * y + a[8]};
    for (std::size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
      const FloatVec column = hn::Iota(d, x + static_cast<float>(i)), w = hn::Load(d, base + i);
      const auto coordinate = [&](std::size_t r) HWY_ATTR {
        return hn::MulAdd(w, set(motion_.b[r]), hn::MulAdd(column, set(a[3 * r]), set(start[r])));
      };
      const FloatVec z = coordinate(2), inverse = reciprocal(Floats(), z);
      place(hn::Mul(coordinate(0), inverse), hn::Mul(coordinate(1), inverse), hn::Gt(z, set(kLeastRatio)), i,
            valid + i);
      // A vector later, because what was just stored is not quickly read again in parts.
      if (i > span.begin) copyTexels(i - hn::Lanes(d));
    }
    if (!span.isEmpty()) copyTexels(span.end - hn::Lanes(d));
    if (mask_ != nullptr) applyMask(span, valid);
  }

  // What lies between the texels fetched, from pixel i on.
  HWY_INLINE IntVec value(std::size_t i) const {
    const Ints di;
    IntVec top, bottom;
    hn::LoadInterleaved2(di, texels_ + 2 * i, top, bottom);
    const IntVec wu = hn::Load(di, weights_ + 2 * i);
    const IntVec wv = hn::Load(di, weights_ + 2 * i + hn::Lanes(di));
    const IntVec upper = hn::ShiftRight<5>(pairProducts(top, wu));
    const IntVec lower = hn::ShiftRight<5>(pairProducts(bottom, wu));
    const IntVec both = hn::Or(upper, hn::ShiftLeft<16>(lower));
    return hn::ShiftRight<11>(hn::Add(pairProducts(both, wv), set(1024)));
  }

 private:
  // One load a pixel: faster than the gathers of some processors.
  HWY_INLINE void copyTexels(std::size_t i) const {
    const std::int32_t* index = index_ + i;
    auto* texels = reinterpret_cast<std::byte*>(texels_ + 2 * i);
    for (std::size_t lane = 0; lane < hn::Lanes(Ints()); ++lane)
      std::memcpy(texels + 8 * lane, quads_ + index[lane], 8);
  }

  HWY_INLINE void place(FloatVec u, FloatVec v, FloatMask before, std::size_t i, std::int32_t* valid) const {
    const Ints di;
    const auto inside = hn::And(hn::And(before, hn::And(hn::Ge(u, set(margin_)), hn::Ge(v, set(margin_)))),
                                hn::And(hn::Le(u, set(right_ - margin_)), hn::Le(v, set(bottom_ - margin_))));
    hn::Store(hn::VecFromMask(di, hn::RebindMask(di, inside)), di, valid);
    const auto fixed = [&](FloatVec c, float last) HWY_ATTR {
      const FloatVec clamped = hn::Min(hn::Max(c, set(0.0F)), set(last));
      return hn::BitCast(di, hn::MulAdd(hn::IfThenElseZero(before, clamped), set(256.0F), set(kUnits)));
    };
    const IntVec fu = fixed(u, right_), fv = fixed(v, bottom_);
    const IntVec index = hn::Add(hn::Mul(hn::ShiftRight<8>(fv), set(stride_)), hn::ShiftRight<8>(fu));
    hn::Store(hn::Sub(index, set(first_)), di, index_ + i);
    hn::Store(pairWeights(hn::And(fu, set(255))), di, weights_ + 2 * i);
    hn::Store(pairWeights(hn::And(fv, set(255))), di, weights_ + 2 * i + hn::Lanes(di));
  }

  void applyMask(const Span& span, std::int32_t* valid) const {
    for (std::size_t i = span.begin; i < span.end; ++i)
      if (mask_[index_[i]] == 0) valid[i] = 0;
  }

  const std::uint64_t* quads_;
  const std::uint8_t* mask_;
  ImageMotion motion_;
  std::int32_t *index_, *weights_, *texels_;
  std::int32_t stride_, first_;
  float margin_, right_, bottom_;
};

// Running sums down the columns of v, v² and u·v over the last `window` rows. What `before`, the span of the
// oldest of them, has beyond that of this row counts as 0: it leaves the sums, and no window asks for it.
HWY_INLINE void addRow(const Warp& warp, const Span& span, const Span& before, const std::int32_t* products,
                       std::size_t stride, std::int32_t* oldest, std::int32_t* columns) {
  const Ints d;
  const auto add = [&](std::int32_t* sum, IntVec x)
                       HWY_ATTR { hn::Store(hn::Add(hn::Load(d, sum), x), d, sum); };
  const auto replace = [&](std::size_t i, IntVec v) HWY_ATTR {
    const IntVec old = hn::ShiftLeft<16>(hn::Load(d, oldest + i)), with_old = hn::Or(v, old);
    add(columns + i, hn::Sub(v, hn::ShiftRight<16>(old)));
    add(columns + stride + i, pairProducts(with_old, hn::Sub(v, old)));
    add(columns + 2 * stride + i, pairProducts(with_old, hn::Load(d, products + i)));
    hn::Store(v, d, oldest + i);
  };
  for (std::size_t i = span.begin; i < span.end; i += hn::Lanes(d)) replace(i, warp.value(i));
  const std::size_t left = span.isEmpty() ? before.end : std::min(before.end, span.begin);
  const std::size_t right = span.isEmpty() ? before.end : std::max(before.begin, span.end);
  for (std::size_t i = before.begin; i < left; i += hn::Lanes(d)) replace(i, hn::Zero(d));
  for (std::size_t i = right; i < before.end; i += hn::Lanes(d)) replace(i, hn::Zero(d));
}

// Σ of 2r + 1 neighbours from x on.
HWY_INLINE IntVec windowSum(const std::int32_t* from, int window) {
  const Ints d;
  IntVec sum = hn::Load(d, from);
  for (int k = 1; k < window; ++k) sum = hn::Add(sum, hn::LoadU(d, from + k));
  return sum;
}

// Σ of five or seven neighbours, one vector after the other. The widest vectors are cheaper to shift than to
// load from anywhere: each of those loads touches two lines of the cache.
template <int kWindow>
class FixedSums {
  static_assert(kWindow == 5 || kWindow == 7);

 public:
#if HWY_TARGET <= HWY_AVX3
  HWY_INLINE explicit FixedSums(const std::int32_t* from)
      : from_(from), here_(load(0)), next_(load(1)), pairs_(hn::Add(here_, later<1>(here_, next_))) {}
  HWY_INLINE IntVec next() {
    const IntVec after = load(2), next_pairs = hn::Add(next_, later<1>(next_, after));
    IntVec sum = hn::Add(pairs_, later<2>(pairs_, next_pairs));
    if constexpr (kWindow == 7) sum = hn::Add(sum, later<4>(pairs_, next_pairs));
    sum = hn::Add(sum, later<kWindow - 1>(here_, next_));
    here_ = next_, next_ = after, pairs_ = next_pairs;
    from_ += hn::Lanes(Ints());
    return sum;
  }

 private:
  HWY_INLINE IntVec load(std::size_t vector) const {
    return hn::Load(Ints(), from_ + vector * hn::Lanes(Ints()));
  }
  template <int kLanes>
  HWY_INLINE static IntVec later(IntVec here, IntVec next) {
    return IntVec{_mm512_alignr_epi32(next.raw, here.raw, kLanes)};
  }

  const std::int32_t* from_;
  IntVec here_, next_, pairs_;
#else
  explicit FixedSums(const std::int32_t* from) : from_(from) {}
  HWY_INLINE IntVec next() {
    const Ints d;
    IntVec sum = hn::Add(hn::Add(hn::Load(d, from_), hn::LoadU(d, from_ + 1)),
                         hn::Add(hn::LoadU(d, from_ + 2), hn::LoadU(d, from_ + 3)));
    if constexpr (kWindow == 7) sum = hn::Add(sum, hn::Add(hn::LoadU(d, from_ + 4), hn::LoadU(d, from_ + 5)));
    sum = hn::Add(sum, hn::LoadU(d, from_ + kWindow - 1));
    from_ += hn::Lanes(d);
    return sum;
  }

 private:
  const std::int32_t* from_;
#endif
};

// The same for any number of neighbours.
class Sums {
 public:
  Sums(const std::int32_t* from, int window) : from_(from), window_(window) {}
  HWY_INLINE IntVec next() {
    const IntVec sum = windowSum(from_, window_);
    from_ += hn::Lanes(Ints());
    return sum;
  }

 private:
  const std::int32_t* from_;
  int window_;
};

// Correlations of one row of windows, at the lanes from i on.
struct RowOfWindows {
  const std::int32_t* valid;
  const float* mean;
  const float* inverse_spread;
  float share, least_spread2;

  // From Σv, Σv² and Σuv.
  HWY_INLINE FloatVec at(std::size_t i, IntVec sum_v, IntVec sum_vv, IntVec sum_uv) const {
    const Floats d;
    const Ints di;
    const FloatVec v = hn::ConvertTo(d, sum_v), vv = hn::ConvertTo(d, sum_vv), uv = hn::ConvertTo(d, sum_uv);
    const FloatVec covariance = hn::NegMulAdd(hn::Load(d, mean + i), v, uv);
    const FloatVec spread2 = hn::NegMulAdd(hn::Mul(v, set(share)), v, vv);
    const FloatVec score = hn::Mul(covariance, hn::Load(d, inverse_spread + i));
    const auto good = hn::And(hn::MaskFromVec(hn::BitCast(d, hn::LoadU(di, valid + i))),
                              hn::Ge(spread2, set(least_spread2)));
    return hn::IfThenElse(good, hn::Mul(score, reciprocalRoot(Floats(), spread2)), set(kNoPeak));
  }
};

// Where a curve has its maximum, from three samples around k.
struct Parabola {
  FloatVec step, score, curvature;
};
HWY_INLINE Parabola parabola(FloatVec before, FloatVec at, FloatVec after, float k) {
  const FloatVec curvature = hn::Sub(hn::Add(at, at), hn::Add(before, after));
  const FloatVec slope = hn::Mul(set(0.5F), hn::Sub(after, before));
  const FloatVec shift = hn::Mul(slope, reciprocal(Floats(), curvature));
  return {hn::Add(set(k), shift), hn::MulAdd(hn::Mul(set(0.5F), shift), slope, at), curvature};
}

class BestSink {
 public:
  explicit BestSink(BestPeaks& peaks) : peaks_(peaks) {}
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
  ListSink(PeakLists& lists, std::size_t index) : lists_(lists), index_(index) {}
  HWY_INLINE void put(std::size_t i, FloatMask is_peak, FloatVec before, FloatVec at, FloatVec after,
                      float k) const {
    const Floats d;
    if (hn::AllFalse(d, is_peak)) return;
    const Parabola top = parabola(before, at, after, k);
    alignas(64) float step[kVectorLanes], score[kVectorLanes];
    hn::Store(top.step, d, step);
    hn::Store(at, d, score);
    std::uint8_t bytes[8] = {};  // all that StoreMaskBits may write
    hn::StoreMaskBits(d, is_peak, bytes);
    for (unsigned bits = bytes[0] | unsigned{bytes[1]} << 8; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      push(i + lane, step[lane], score[lane]);
    }
  }

 private:
  void push(std::size_t pixel, float step, float score) const {
    std::uint8_t& count = lists_.counts[index_ * lists_.pixels + pixel];
    const std::size_t first = index_ * kMostPeaks * lists_.pixels + pixel;
    std::size_t place = first + count * lists_.pixels;
    if (count == kMostPeaks) {
      place = first;
      for (std::size_t k = 1; k < kMostPeaks; ++k) {
        const std::size_t other = first + k * lists_.pixels;
        if (lists_.score[other] < lists_.score[place]) place = other;
      }
      if (lists_.score[place] >= score) return;
    } else {
      ++count;
    }
    lists_.step[place] = step, lists_.score[place] = score;
  }

  PeakLists& lists_;
  std::size_t index_;
};

// Three samples of all curves of a tile, the last one new.
struct Samples {
  const float *before, *at;
  float* now;
};

// A local maximum lies at the sample before this one where the curve falls now and did not before. `from`:
// pixel at which the row begins.
template <class Sum, class Sink>
HWY_INLINE void lookForPeaks(const RowOfWindows& row, Sum v, Sum vv, Sum uv, const Span& span,
                             std::size_t from, const Samples& samples, float k, float threshold,
                             const Sink& sink) {
  const Floats d;
  for (std::size_t i = span.begin; i < span.end; i += hn::Lanes(d)) {
    const FloatVec after = row.at(i, v.next(), vv.next(), uv.next());
    const FloatVec s0 = hn::Load(d, samples.before + from + i), s1 = hn::Load(d, samples.at + from + i);
    hn::Store(after, d, samples.now + from + i);
    // A sample without a window is no lower neighbour.
    const auto is_peak =
        hn::And(hn::And(hn::Gt(s1, set(threshold)), hn::And(hn::Gt(s1, s0), hn::Ge(s1, after))),
                hn::And(hn::Gt(s0, set(kNoPeak)), hn::Gt(after, set(kNoPeak))));
    sink.put(from + i, is_peak, s0, s1, after, k);
  }
}

// The windows whose last row has just been added: those of row `line` of the tile.
template <class Sink>
HWY_INLINE void lookAtLine(const SweepTile& tile, const Span& span, int line, const SweepLimits& limits,
                           const SweepMemory& memory, const Samples& samples, float k, const Sink& sink) {
  const auto stride = static_cast<std::size_t>(tile.stride);
  const std::size_t from = tile.at(0, line);
  const int window = tile.window();
  const std::size_t centre = static_cast<std::size_t>((line + tile.radius) % window) * stride;
  const RowOfWindows row{memory.valid.data() + centre + static_cast<std::size_t>(tile.radius),
                         tile.mean.data() + from, tile.inverse_spread.data() + from,
                         1.0F / static_cast<float>(window * window), limits.least_spread2};
  const auto look = [&](auto v, auto vv, auto uv) HWY_ATTR {
    lookForPeaks(row, v, vv, uv, span, from, samples, k, limits.threshold, sink);
  };
  const std::int32_t *v = memory.columns.data() + span.begin, *vv = v + stride, *uv = vv + stride;
  if (window == 5)
    look(FixedSums<5>(v), FixedSums<5>(vv), FixedSums<5>(uv));
  else if (window == 7)
    look(FixedSums<7>(v), FixedSums<7>(vv), FixedSums<7>(uv));
  else
    look(Sums(v, window), Sums(vv, window), Sums(uv, window));
}

// All windows at one inverse depth.
template <class Sink>
HWY_INLINE void sweepOnce(const SweepTile& tile, const SweepSpans& spans, const Warp& warp,
                          const SweepLimits& limits, SweepMemory& memory, const Samples& samples, float k,
                          const Sink& sink) {
  const auto stride = static_cast<std::size_t>(tile.stride), rows = static_cast<std::size_t>(tile.window());
  std::fill(memory.ring.begin(), memory.ring.end(), 0);
  std::fill(memory.columns.begin(), memory.columns.end(), 0);
  for (std::size_t y = 0; y < spans.pixels.size(); ++y) {
    const std::size_t slot = y % rows * stride;
    const int row = static_cast<int>(y), line = row - 2 * tile.radius;
    const Span span = spans.pixels[y], before = y < rows ? Span{} : spans.pixels[y - rows];
    warp.fetch(static_cast<float>(tile.x0 - tile.radius), static_cast<float>(tile.y0 - tile.radius + row),
               tile.base.data() + tile.at(0, row), span, memory.valid.data() + slot);
    addRow(warp, span, before, tile.products.data() + tile.at(0, row), stride, memory.ring.data() + slot,
           memory.columns.data());
    if (line < 0 || spans.windows[static_cast<std::size_t>(line)].isEmpty()) continue;
    lookAtLine(tile, spans.windows[static_cast<std::size_t>(line)], line, limits, memory, samples, k, sink);
  }
}

template <class Sink>
void sweep(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
           const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, const Sink& sink) {
  const auto stride = static_cast<std::size_t>(tile.stride), rows = static_cast<std::size_t>(tile.window());
  // Loads from a row's end may reach beyond it.
  memory.ring.resize(rows * stride), memory.valid.resize((rows + 1) * stride);
  memory.columns.resize(3 * stride + 2 * kVectorLanes);
  memory.index.resize(stride), memory.weights.resize(2 * stride), memory.texels.resize(2 * stride);
  for (AlignedFloats& curve : memory.curve) curve.assign(tile.at(0, tile.height), kNoPeak);
  const SweepSpans spans = sweepSpans(tile);
  for (int k = 0; k < range.count; ++k) {
    const Warp warp(partner, motion, range.first + static_cast<float>(k) * range.step, tile.radius, memory);
    const auto curve = [&](int age) {
      return memory.curve[static_cast<std::size_t>((k + 3 - age) % 3)].data();
    };
    sweepOnce(tile, spans, warp, limits, memory, {curve(2), curve(1), curve(0)}, static_cast<float>(k - 1),
              sink);
  }
}

void sweepBest(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
               const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, BestPeaks& peaks) {
  sweep(tile, partner, motion, range, limits, memory, BestSink(peaks));
}

void sweepAll(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
              const SweepRange& range, const SweepLimits& limits, std::size_t index, SweepMemory& memory,
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
  const auto [a, b] =
      paper::rayImage({"", reference, world_from_reference}, {"", partner, world_from_partner});
  ImageMotion motion;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) motion.a[static_cast<std::size_t>(3 * r + c)] = static_cast<float>(a(r, c));
    motion.b[static_cast<std::size_t>(r)] = static_cast<float>(b(r));
  }
  return motion;
}

void PeakLists::clear(const SweepTile& tile, std::size_t partners) {
  pixels = tile.at(0, tile.height);
  counts.assign(partners * pixels, 0);
  score.assign(partners * kMostPeaks * pixels, kNoPeak), step.resize(score.size());
}

void sweepForBest(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
                  const SweepRange& range, const SweepLimits& limits, SweepMemory& memory, BestPeaks& peaks) {
  const std::size_t size = tile.at(0, tile.height);
  peaks.score.assign(size, kNoPeak);
  peaks.step.resize(size), peaks.curvature.resize(size);
  HWY_DYNAMIC_DISPATCH(sweepBest)(tile, partner, motion, range, limits, memory, peaks);
}

void sweepForAll(const SweepTile& tile, const PictureLevel& partner, const ImageMotion& motion,
                 const SweepRange& range, const SweepLimits& limits, std::size_t index, SweepMemory& memory,
                 PeakLists& peaks) {
  HWY_DYNAMIC_DISPATCH(sweepAll)(tile, partner, motion, range, limits, index, memory, peaks);
}

}  // namespace vdbfuse::stereo
#endif
