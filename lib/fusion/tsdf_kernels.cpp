// SPDX-License-Identifier: Apache-2.0
#include "fusion/tsdf_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fusion/tsdf_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 64>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
using FloatMask = hn::Mask<Floats>;

HWY_INLINE FloatVec set(float value) { return hn::Set(Floats(), value); }

void sightPinhole(const PinholeRows& camera, float voxel, LeafSight& sight) {
  const Floats d;
  std::array<std::array<float, 4>, 3> rows = camera.rows;
  for (auto& row : rows)
    for (std::size_t c = 0; c < 3; ++c) row[c] *= voxel;
  // Lanes run along z; a vector longer than a row runs on into the next y.
  const auto lane = hn::Iota(d, 0.0f);
  const auto y_lane = hn::Floor(hn::Mul(lane, set(0.125f)));
  const auto z_lane = hn::NegMulAdd(y_lane, set(8.0f), lane);
  const auto along = [&](std::size_t r) {
    return hn::MulAdd(set(rows[r][1]), y_lane, hn::Mul(set(rows[r][2]), z_lane));
  };
  const auto along_u = along(0), along_v = along(1), along_depth = along(2);
  for (std::size_t i = 0; i < kTsdfLeaf; i += hn::Lanes(d)) {
    const auto x = static_cast<float>(i >> 6), y = static_cast<float>(i >> 3 & 7),
               z = static_cast<float>(i & 7);
    const auto from = [&](std::size_t r) {
      return set(rows[r][0] * x + rows[r][1] * y + rows[r][2] * z + rows[r][3]);
    };
    const auto depth = hn::Add(from(2), along_depth);
    const auto inverse = hn::Div(set(1.0f), depth);
    hn::Store(hn::Mul(hn::Add(from(0), along_u), inverse), d, &sight.u[i]);
    hn::Store(hn::Mul(hn::Add(from(1), along_v), inverse), d, &sight.v[i]);
    hn::Store(depth, d, &sight.depth[i]);
  }
}

HWY_INLINE FloatMask insideImage(FloatVec u, FloatVec v, FloatVec depth, int width, int height) {
  const FloatVec low = set(-0.5f);
  return hn::And(hn::And(hn::Gt(depth, set(0.0f)), hn::And(hn::Ge(u, low), hn::Ge(v, low))),
                 hn::And(hn::Lt(u, set(static_cast<float>(width) - 0.5f)),
                         hn::Lt(v, set(static_cast<float>(height) - 0.5f))));
}

// The four pixels around each voxel's projection, and how far it lies between them.
struct Cell {
  IntVec at;  ///< the upper left one
  FloatVec fu, fv;
};

HWY_INLINE Cell cellOf(FloatVec u, FloatVec v, FloatMask wanted, int width, int height) {
  const Ints di;
  const auto first = [&](FloatVec x, int size) HWY_ATTR {
    return hn::Min(hn::ConvertTo(di, hn::IfThenElseZero(wanted, hn::Max(x, set(0.0f)))),
                   hn::Set(di, size - 2));
  };
  const IntVec column = first(u, width), line = first(v, height);
  const auto share = [&](FloatVec x, IntVec c) HWY_ATTR {
    return hn::Min(hn::Max(hn::Sub(x, hn::ConvertTo(Floats(), c)), set(0.0f)), set(1.0f));
  };
  return {hn::Add(hn::Mul(line, hn::Set(di, width)), column), share(u, column), share(v, line)};
}

HWY_INLINE FloatVec bilinear(FloatVec fu, FloatVec fv, FloatVec a, FloatVec b, FloatVec c, FloatVec d) {
  const FloatVec top = hn::MulAdd(fu, hn::Sub(b, a), a), bottom = hn::MulAdd(fu, hn::Sub(d, c), c);
  return hn::MulAdd(fv, hn::Sub(bottom, top), top);
}

// Copies `kBytes` bytes each from from[stride·index[k]] to to[kBytes·k]: a gather of more than a number beats
// several of one.
template <std::size_t kBytes>
HWY_INLINE void collect(const void* from, std::size_t stride, const std::int32_t* index, std::size_t count,
                        void* to) {
  const auto* source = static_cast<const std::byte*>(from);
  auto* target = static_cast<std::byte*>(to);
  for (std::size_t k = 0; k < count; ++k)
    std::memcpy(target + kBytes * k, source + stride * static_cast<std::size_t>(index[k]), kBytes);
}

// The pixels nearest to the voxels of a leaf.
class NearestPixels {
 public:
  struct Sight {
    FloatMask seen;
    FloatVec distance, weight;
  };

  HWY_INLINE NearestPixels(const LeafSight& sight, const DepthPixels& pixels) : sight_(sight) {
    const Floats df;
    const Ints di;
    alignas(64) std::array<std::int32_t, kTsdfLeaf> pixel;
    const auto round = [&](FloatVec x, FloatMask inside, int last) HWY_ATTR {
      // Rounding up may reach the next column.
      return hn::Min(hn::ConvertTo(di, hn::IfThenElseZero(inside, hn::Add(x, set(0.5f)))), hn::Set(di, last));
    };
    auto any = hn::Gt(hn::Zero(df), hn::Zero(df));
    for (std::size_t i = 0; i < kTsdfLeaf; i += hn::Lanes(df)) {
      const FloatVec u = hn::Load(df, &sight.u[i]), v = hn::Load(df, &sight.v[i]);
      const auto inside = insideImage(u, v, hn::Load(df, &sight.depth[i]), pixels.width, pixels.height);
      any = hn::Or(any, inside);
      const IntVec index = hn::Add(hn::Mul(round(v, inside, pixels.height - 1), hn::Set(di, pixels.width)),
                                   round(u, inside, pixels.width - 1));
      const IntVec nothing = hn::Set(di, pixels.width * pixels.height);
      hn::Store(hn::IfThenElse(hn::RebindMask(di, inside), index, nothing), di, &pixel[i]);
    }
    is_seen_ = !hn::AllFalse(df, any);
    if (is_seen_)
      collect<sizeof(DepthPixel)>(pixels.at, sizeof(DepthPixel), pixel.data(), kTsdfLeaf, values_.data());
  }

  /// Some voxel falls into the image.
  bool isSeen() const { return is_seen_; }
  /// What they say of the voxels from the i-th on. REQUIRES: isSeen().
  HWY_INLINE Sight at(std::size_t i) const {
    const Floats df;
    FloatVec measured, weight;
    hn::LoadInterleaved2(df, &values_[2 * i], measured, weight);
    const auto seen = hn::And(hn::Gt(measured, hn::Zero(df)), hn::Gt(weight, hn::Zero(df)));
    return {seen, hn::Sub(measured, hn::Load(df, &sight_.depth[i])), weight};
  }

 private:
  const LeafSight& sight_;
  bool is_seen_;
  alignas(64) std::array<float, 2 * kTsdfLeaf> values_;
};

// What a view says of the voxels of a leaf. Those in its band (a fifth of them or so) are set side by side:
// which they are is decided by the nearest pixel, how far they lie from it by those around.
class LeafMeasurements {
 public:
  /// `touched` + kBytes·i: what is about to be read of voxel i.
  template <std::size_t kBytes>
  HWY_INLINE LeafMeasurements(const LeafSight& sight, const DepthPixels& pixels, float reach,
                              const std::array<std::byte, kBytes>* touched)
      : pixels_(pixels), nearest_(sight, pixels), reach_(reach) {
    const Floats df;
    const Ints di;
    if (!nearest_.isSeen()) return;
    for (std::size_t i = 0; i < kTsdfLeaf; i += hn::Lanes(df)) {
      const NearestPixels::Sight near = nearest_.at(i);
      const auto reached = hn::And(near.seen, hn::Ge(near.distance, set(-reach)));
      if (hn::AllFalse(df, reached)) continue;
      const auto is_in_front = hn::Gt(near.distance, set(reach));
      if (!hn::AllFalse(df, hn::And(near.seen, is_in_front)))
        before_[before_count_++] = static_cast<std::uint16_t>(i);
      const auto in_band = hn::AndNot(is_in_front, reached);
      if (hn::AllFalse(df, in_band)) continue;
      for (std::size_t line = 0; line < hn::Lanes(df) * kBytes; line += 64)
        __builtin_prefetch(reinterpret_cast<const std::byte*>(touched + i) + line, 1);
      // In the register: some machines take a hundred cycles to compress into memory.
      const auto append = [&](FloatVec x, std::array<float, kRoom>& to)
                              HWY_ATTR { hn::StoreU(hn::Compress(x, in_band), df, &to[count_]); };
      append(hn::Load(df, &sight.u[i]), u_), append(hn::Load(df, &sight.v[i]), v_);
      append(hn::Load(df, &sight.depth[i]), depth_), append(near.weight, weight_);
      const IntVec voxel = hn::Iota(di, static_cast<int>(i));
      hn::StoreU(hn::Compress(voxel, hn::RebindMask(di, in_band)), di, &voxel_[count_]);
      count_ += hn::CountTrue(df, in_band);
    }
  }

  /// Voxels in the band, and their places in the leaf.
  std::size_t count() const { return count_; }
  const std::int32_t* voxels() const { return voxel_.data(); }

  /// visit(i, before, weight) for the vectors of voxels from the i-th on, where some lie beyond the band, but
  /// no further than `furthest`, before a measurement.
  template <class Visit>
  HWY_INLINE void forEachBefore(float furthest, const Visit& visit) const {
    const Floats df;
    for (std::size_t n = 0; n < before_count_; ++n) {
      const std::size_t i = before_[n];
      const NearestPixels::Sight near = nearest_.at(i);
      const auto before = hn::And(
          near.seen, hn::And(hn::Gt(near.distance, set(reach_)), hn::Le(near.distance, set(furthest))));
      if (!hn::AllFalse(df, before)) visit(i, before, near.weight);
    }
  }

  /// visit(k, distance, weight) for the vectors of voxels in the band from the k-th on; the last one is
  /// filled up with weight 0. The distance is between −reach and reach.
  template <class Visit>
  HWY_INLINE void forEachInBand(const Visit& visit) const {
    const Floats df;
    const Ints di;
    const std::size_t lanes = hn::Lanes(df);
    const FloatVec half = set(0.5f), none = set(0.0f);
    alignas(64) std::array<std::int32_t, hn::MaxLanes(df)> at;
    alignas(64) std::array<float, 2 * hn::MaxLanes(df)> above, below;
    for (std::size_t k = 0; k < count_; k += lanes) {
      const auto used = hn::FirstN(df, std::min(lanes, count_ - k));
      const Cell cell =
          cellOf(hn::LoadU(df, &u_[k]), hn::LoadU(df, &v_[k]), used, pixels_.width, pixels_.height);
      hn::Store(cell.at, di, at.data());
      collect<2 * sizeof(float)>(pixels_.depth, sizeof(float), at.data(), lanes, above.data());
      collect<2 * sizeof(float)>(pixels_.depth + pixels_.width, sizeof(float), at.data(), lanes,
                                 below.data());
      FloatVec a, b, c, d;
      hn::LoadInterleaved2(df, above.data(), a, b);
      hn::LoadInterleaved2(df, below.data(), c, d);
      const auto right = hn::Ge(cell.fu, half), low = hn::Ge(cell.fv, half);
      const FloatVec nearest = hn::IfThenElse(low, hn::IfThenElse(right, d, c), hn::IfThenElse(right, b, a));
      const FloatVec least = hn::Min(hn::Min(a, b), hn::Min(c, d)),
                     most = hn::Max(hn::Max(a, b), hn::Max(c, d));
      const FloatVec jump = hn::MulAdd(least, set(pixels_.edge.relative), set(pixels_.edge.absolute));
      const auto one_surface = hn::And(hn::Gt(least, none), hn::Le(hn::Sub(most, least), jump));
      const FloatVec measured = hn::IfThenElse(one_surface, bilinear(cell.fu, cell.fv, a, b, c, d), nearest);
      const FloatVec distance = hn::Sub(measured, hn::LoadU(df, &depth_[k]));
      visit(k, hn::Min(hn::Max(distance, set(-reach_)), set(reach_)),
            hn::IfThenElseZero(used, hn::LoadU(df, &weight_[k])));
    }
  }

 private:
  // Compressed stores and the last vector may run beyond what is used.
  static constexpr std::size_t kRoom = kTsdfLeaf + 64;
  const DepthPixels& pixels_;
  NearestPixels nearest_;
  float reach_;
  std::size_t count_ = 0, before_count_ = 0;
  std::array<std::uint16_t, kTsdfLeaf> before_;  ///< vectors that hold voxels before the band
  alignas(64) std::array<std::int32_t, kRoom> voxel_;
  alignas(64) std::array<float, kRoom> u_, v_, depth_, weight_;
};

// (mean distance, weight) of as many voxels as a vector holds.
struct SingleVoxels {
  using Value = float;
  FloatVec distance, weight;
  SingleVoxels(const float* at, const TsdfUpdate&) { hn::LoadInterleaved2(Floats(), at, distance, weight); }
  static void store(FloatVec d, FloatVec w, const TsdfUpdate&, float* at) {
    hn::StoreInterleaved2(d, w, Floats(), at);
  }
};

struct HalfVoxels {
  using Value = std::int16_t;
  using Shorts = hn::Rebind<std::int16_t, Floats>;
  FloatVec distance, weight;
  HalfVoxels(const std::int16_t* at, const TsdfUpdate& update) {
    hn::Vec<Shorts> d, w;
    hn::LoadInterleaved2(Shorts(), at, d, w);
    const auto widen = [](hn::Vec<Shorts> x, float scale) HWY_ATTR {
      return hn::Mul(hn::ConvertTo(Floats(), hn::PromoteTo(Ints(), x)), set(scale));
    };
    distance = widen(d, update.truncation / kHalfOne), weight = widen(w, 1 / kHalfWeight);
  }
  static void store(FloatVec d, FloatVec w, const TsdfUpdate& update, std::int16_t* at) {
    const auto narrow = [](FloatVec x, float scale) HWY_ATTR {
      return hn::DemoteTo(Shorts(), hn::NearestInt(hn::Mul(x, set(scale))));
    };
    hn::StoreInterleaved2(narrow(d, kHalfOne / update.truncation),
                          narrow(hn::Min(w, set(kHalfMost)), kHalfWeight), Shorts(), at);
  }
};

// The running mean of voxels when distances with weights are taken in, or out; those of weight 0 stay as they
// are.
template <class Voxels>
HWY_INLINE void mix(FloatVec distance, FloatVec weight, const TsdfUpdate& update,
                    typename Voxels::Value* at) {
  const Voxels old(at, update);
  const auto seen = hn::Gt(weight, set(0.0f));
  const FloatVec moved = hn::Mul(set(update.sign), weight);
  const FloatVec sum = hn::Add(old.weight, moved);
  const auto something = hn::Gt(sum, set(update.least_weight));
  const FloatVec step = hn::Div(moved, hn::IfThenElse(something, sum, set(1.0f)));
  const FloatVec mean = hn::MulAdd(hn::Sub(distance, old.distance), step, old.distance);
  Voxels::store(hn::IfThenElse(seen, hn::IfThenElseZero(something, mean), old.distance),
                hn::IfThenElse(seen, hn::IfThenElseZero(something, sum), old.weight), update, at);
}

template <class Voxels>
HWY_INLINE LeafChange updateVoxels(const LeafSight& sight, const DepthPixels& pixels,
                                   const TsdfUpdate& update, typename Voxels::Value* voxels) {
  using Value = typename Voxels::Value;
  const Floats df;
  const LeafMeasurements measurements(
      sight, pixels, update.truncation,
      reinterpret_cast<const std::array<std::byte, 2 * sizeof(Value)>*>(voxels));
  LeafChange change{static_cast<int>(measurements.count()), 0};
  if (change.in_band == 0) return change;
  measurements.forEachBefore(
      update.furthest_before, [&](std::size_t i, FloatMask before, FloatVec weight) HWY_ATTR {
        change.before += static_cast<int>(hn::CountTrue(df, before));
        mix<Voxels>(set(update.truncation), hn::IfThenElseZero(before, weight), update, voxels + 2 * i);
      });
  alignas(64) std::array<Value, 2 * hn::MaxLanes(df)> some;
  measurements.forEachInBand([&](std::size_t k, FloatVec distance, FloatVec weight) HWY_ATTR {
    const std::size_t count = std::min(hn::Lanes(df), measurements.count() - k);
    const std::int32_t* places = measurements.voxels() + k;
    collect<2 * sizeof(Value)>(voxels, 2 * sizeof(Value), places, count, some.data());
    mix<Voxels>(distance, weight, update, some.data());
    for (std::size_t j = 0; j < count; ++j)
      std::memcpy(voxels + 2 * places[j], &some[2 * j], 2 * sizeof(Value));
  });
  return change;
}

template <class Voxels>
HWY_INLINE int carveVoxels(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                           typename Voxels::Value* voxels) {
  const Floats df;
  const NearestPixels nearest(sight, pixels);
  if (!nearest.isSeen()) return 0;
  int count = 0;
  for (std::size_t i = 0; i < kTsdfLeaf; i += hn::Lanes(df)) {
    const NearestPixels::Sight near = nearest.at(i);
    auto before = hn::And(near.seen, hn::Gt(near.distance, set(update.furthest_before)));
    if (hn::AllFalse(df, before)) continue;
    before = hn::And(before, hn::Gt(Voxels(voxels + 2 * i, update).weight, set(update.least_weight)));
    if (hn::AllFalse(df, before)) continue;
    count += static_cast<int>(hn::CountTrue(df, before));
    mix<Voxels>(set(update.truncation), hn::IfThenElseZero(before, near.weight), update, voxels + 2 * i);
  }
  return count;
}

LeafChange updateSingle(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                        float* voxels) {
  return updateVoxels<SingleVoxels>(sight, pixels, update, voxels);
}

LeafChange updateHalf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                      std::int16_t* voxels) {
  return updateVoxels<HalfVoxels>(sight, pixels, update, voxels);
}

int carveSingle(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update, float* voxels) {
  return carveVoxels<SingleVoxels>(sight, pixels, update, voxels);
}

int carveHalf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
              std::int16_t* voxels) {
  return carveVoxels<HalfVoxels>(sight, pixels, update, voxels);
}

void weighColors(const LeafSight& sight, const DepthPixels& pixels, float reach, float* weights) {
  const Floats df;
  std::fill_n(weights, kTsdfLeaf, 0.0f);
  const LeafMeasurements measurements(sight, pixels, reach,
                                      reinterpret_cast<const std::array<std::byte, sizeof(float)>*>(weights));
  alignas(64) std::array<float, hn::MaxLanes(df)> some;
  measurements.forEachInBand([&](std::size_t k, FloatVec distance, FloatVec weight) HWY_ATTR {
    // The nearer the better: off the surface, oblique rays meet it beside the voxel.
    const FloatVec near = hn::Sub(set(1.0f), hn::Div(hn::Abs(distance), set(reach)));
    const FloatVec counted = hn::Mul(weight, hn::Mul(near, near));
    const FloatVec quanta = hn::ConvertTo(df, hn::NearestInt(hn::Mul(counted, set(kColorWeight))));
    hn::Store(hn::Mul(hn::Max(quanta, set(1.0f)), set(1 / kColorWeight)), df, some.data());
    for (std::size_t j = 0; j < std::min(hn::Lanes(df), measurements.count() - k); ++j)
      weights[measurements.voxels()[k + j]] = some[j];
  });
}

void mixColors(const LeafSight& sight, const ColorPixels& pixels, const float* weights, float sign,
               std::uint16_t* voxels) {
  const Floats df;
  const Ints di;
  const hn::Rebind<std::uint16_t, Floats> ds;
  const auto* rgb = reinterpret_cast<const std::int32_t*>(pixels.rgb);
  for (std::size_t i = 0; i < kTsdfLeaf; i += hn::Lanes(df)) {
    const FloatVec weight = hn::LoadU(df, weights + i);
    const FloatVec u = hn::Load(df, &sight.u[i]), v = hn::Load(df, &sight.v[i]);
    const auto wanted = hn::And(hn::Gt(weight, set(0.0f)), insideImage(u, v, hn::Load(df, &sight.depth[i]),
                                                                       pixels.width, pixels.height));
    if (hn::AllFalse(df, wanted)) continue;
    const Cell cell = cellOf(u, v, wanted, pixels.width, pixels.height);
    const auto* below = rgb + pixels.width;
    const IntVec a = hn::GatherIndex(di, rgb, cell.at), b = hn::GatherIndex(di, rgb + 1, cell.at),
                 c = hn::GatherIndex(di, below, cell.at), d = hn::GatherIndex(di, below + 1, cell.at);

    hn::Vec<decltype(ds)> channels[4];
    hn::LoadInterleaved4(ds, voxels + 4 * i, channels[0], channels[1], channels[2], channels[3]);
    const auto widen = [&](hn::Vec<decltype(ds)> x, float one) {
      return hn::Mul(hn::ConvertTo(df, hn::PromoteTo(di, x)), set(1 / one));
    };
    const auto narrow = [&](FloatVec x, float one) {
      return hn::DemoteTo(ds, hn::NearestInt(hn::Mul(x, set(one))));
    };
    const FloatVec old_weight = widen(channels[3], kColorWeight), moved = hn::Mul(set(sign), weight);
    const FloatVec sum = hn::Min(hn::Add(old_weight, moved), set(65535.0f / kColorWeight));
    const auto something = hn::Gt(sum, set(0.5f / kColorWeight));
    const FloatVec step = hn::Div(moved, hn::IfThenElse(something, sum, set(1.0f)));
    const auto mixed = [&](FloatVec seen, int channel) {
      const FloatVec old = widen(channels[channel], kColorOne);
      const FloatVec mean = hn::MulAdd(hn::Sub(seen, old), step, old);
      const FloatVec kept = hn::IfThenElseZero(something, hn::Min(hn::Max(mean, set(0.0f)), set(255.0f)));
      channels[channel] = narrow(hn::IfThenElse(wanted, kept, old), kColorOne);
    };
    const auto part = [&](IntVec pixel) { return hn::ConvertTo(df, hn::And(pixel, hn::Set(di, 255))); };
    const auto between = [&](IntVec pa, IntVec pb, IntVec pc, IntVec pd) {
      return bilinear(cell.fu, cell.fv, part(pa), part(pb), part(pc), part(pd));
    };
    mixed(between(a, b, c, d), 0);
    mixed(between(hn::ShiftRight<8>(a), hn::ShiftRight<8>(b), hn::ShiftRight<8>(c), hn::ShiftRight<8>(d)), 1);
    mixed(between(hn::ShiftRight<16>(a), hn::ShiftRight<16>(b), hn::ShiftRight<16>(c), hn::ShiftRight<16>(d)),
          2);
    channels[3] =
        narrow(hn::IfThenElse(wanted, hn::IfThenElseZero(something, sum), old_weight), kColorWeight);
    hn::StoreInterleaved4(channels[0], channels[1], channels[2], channels[3], ds, voxels + 4 * i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse {
namespace {

HWY_EXPORT(sightPinhole);
HWY_EXPORT(updateSingle);
HWY_EXPORT(updateHalf);
HWY_EXPORT(carveSingle);
HWY_EXPORT(carveHalf);
HWY_EXPORT(weighColors);
HWY_EXPORT(mixColors);

}  // namespace

void sightLeaf(const PinholeRows& camera, float voxel, LeafSight& sight) {
  HWY_DYNAMIC_DISPATCH(sightPinhole)(camera, voxel, sight);
}

LeafChange updateLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                      float* voxels) {
  return HWY_DYNAMIC_DISPATCH(updateSingle)(sight, pixels, update, voxels);
}

LeafChange updateLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
                      std::int16_t* voxels) {
  return HWY_DYNAMIC_DISPATCH(updateHalf)(sight, pixels, update, voxels);
}

int carveLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update, float* voxels) {
  return HWY_DYNAMIC_DISPATCH(carveSingle)(sight, pixels, update, voxels);
}

int carveLeaf(const LeafSight& sight, const DepthPixels& pixels, const TsdfUpdate& update,
              std::int16_t* voxels) {
  return HWY_DYNAMIC_DISPATCH(carveHalf)(sight, pixels, update, voxels);
}

void colorWeights(const LeafSight& sight, const DepthPixels& pixels, float reach, float* weights) {
  HWY_DYNAMIC_DISPATCH(weighColors)(sight, pixels, reach, weights);
}

void updateColors(const LeafSight& sight, const ColorPixels& pixels, const float* weights, float sign,
                  std::uint16_t* voxels) {
  HWY_DYNAMIC_DISPATCH(mixColors)(sight, pixels, weights, sign, voxels);
}

}  // namespace vdbfuse
#endif
