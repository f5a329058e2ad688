// SPDX-License-Identifier: Apache-2.0
#include "stereo/plane_fit.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/plane_fit.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "stereo/plane_rows.h"
#include "stereo/reciprocals-inl.h"
#include "vdbfuse/base/parallel.h"

HWY_BEFORE_NAMESPACE();
namespace vdbfuse::stereo {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kVectorLanes>;
using FloatVec = hn::Vec<Floats>;
HWY_INLINE FloatVec set(float value) { return hn::Set(Floats(), value); }

// a + b·Δx + c·Δy, relative to the value in the middle.
struct Plane {
  FloatVec a, b, c;
};

// Sums along one row.
struct RowMoments {
  FloatVec w, x, xx, v, vx;

  HWY_INLINE void add(FloatVec weight, FloatVec value, float dx) {
    const FloatVec wv = hn::Mul(weight, value);
    w = hn::Add(w, weight), v = hn::Add(v, wv);
    x = hn::MulAdd(weight, set(dx), x), xx = hn::MulAdd(weight, set(dx * dx), xx);
    vx = hn::MulAdd(wv, set(dx), vx);
  }
};

// Sums of the normal equations.
struct Moments {
  FloatVec w, x, y, xx, xy, yy, v, vx, vy;
  FloatVec all;  // weights before they are lessened

  HWY_INLINE void add(const RowMoments& row, float dy) {
    w = hn::Add(w, row.w), x = hn::Add(x, row.x), xx = hn::Add(xx, row.xx);
    y = hn::MulAdd(row.w, set(dy), y), yy = hn::MulAdd(row.w, set(dy * dy), yy);
    xy = hn::MulAdd(row.x, set(dy), xy);
    v = hn::Add(v, row.v), vx = hn::Add(vx, row.vx), vy = hn::MulAdd(row.v, set(dy), vy);
  }

  HWY_INLINE Plane solve() const {
    // Where the pixels say nothing of a slant there is none.
    const FloatVec some = hn::Max(w, set(1e-20F)), inverse = hn::Div(set(1.0F), some);
    const FloatVec ridge = hn::Mul(some, set(0.1F));
    const FloatVec mx = hn::Mul(x, inverse), my = hn::Mul(y, inverse), mv = hn::Mul(v, inverse);
    const FloatVec cxx = hn::Add(hn::NegMulAdd(mx, x, xx), ridge),
                   cyy = hn::Add(hn::NegMulAdd(my, y, yy), ridge);
    const FloatVec cxy = hn::NegMulAdd(mx, y, xy), cvx = hn::NegMulAdd(mv, x, vx),
                   cvy = hn::NegMulAdd(mv, y, vy);
    const FloatVec determinant = hn::NegMulAdd(cxy, cxy, hn::Mul(cxx, cyy));
    const FloatVec scale = hn::Div(set(1.0F), determinant);
    const FloatVec b = hn::Mul(hn::NegMulAdd(cxy, cvy, hn::Mul(cyy, cvx)), scale);
    const FloatVec c = hn::Mul(hn::NegMulAdd(cxy, cvx, hn::Mul(cxx, cvy)), scale);
    return {hn::NegMulAdd(c, my, hn::NegMulAdd(b, mx, mv)), b, c};
  }
};

HWY_INLINE Moments gather(const PlaneRows& rows, std::size_t at, FloatVec middle, const Plane& plane,
                          float scale) {
  const Floats d;
  const FloatVec zero = hn::Zero(d), sharpness = set(1 / (scale * scale));
  Moments moments{zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
  const int radius = rows.radius;
  for (int dy = -radius; dy <= radius; ++dy) {
    const auto row = static_cast<std::ptrdiff_t>(at) + static_cast<std::ptrdiff_t>(dy) * rows.stride;
    const FloatVec start = hn::MulAdd(plane.c, set(static_cast<float>(dy)), plane.a);
    RowMoments sums{zero, zero, zero, zero, zero};
    for (int dx = -radius; dx <= radius; ++dx) {
      const auto fx = static_cast<float>(dx);
      const FloatVec value = hn::Sub(hn::LoadU(d, rows.value + row + dx), middle);
      const FloatVec off = hn::Sub(value, hn::MulAdd(plane.b, set(fx), start));
      const FloatVec near = reciprocal(d, hn::MulAdd(hn::Mul(off, off), sharpness, set(1.0F)));
      const FloatVec weight = hn::LoadU(d, rows.weight + row + dx);
      moments.all = hn::Add(moments.all, weight);
      sums.add(hn::Mul(weight, hn::Mul(near, near)), value, fx);
    }
    moments.add(sums, static_cast<float>(dy));
  }
  return moments;
}

void fitRow(const PlaneRows& rows, std::size_t at, std::size_t count, const PlaneLines& lines) {
  const Floats d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const FloatVec middle = hn::LoadU(d, rows.value + at + i);
    const FloatVec weight = hn::LoadU(d, rows.weight + at + i);
    if (hn::AllTrue(d, hn::Eq(weight, set(0.0F)))) {
      for (float* line : lines) hn::StoreU(set(0.0F), d, line + i);
      continue;
    }
    Plane plane{set(0.0F), set(0.0F), set(0.0F)};
    FloatVec share = set(0.0F);
    float scale = rows.first_scale;
    for (int round = 0; round < rows.rounds; ++round) {
      const Moments moments = gather(rows, at + i, middle, plane, scale);
      plane = moments.solve();
      share = hn::Div(moments.w, hn::Max(moments.all, set(1e-20F)));
      scale = std::max(rows.scale, 0.5F * scale);
    }
    const auto is_known = hn::Gt(weight, set(0.0F));
    const FloatVec values[] = {hn::Add(middle, plane.a), plane.b, plane.c, share};
    for (std::size_t k = 0; k < lines.size(); ++k)
      hn::StoreU(hn::IfThenElseZero(is_known, values[k]), d, lines[k] + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse::stereo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse::stereo {

HWY_EXPORT(fitRow);

namespace {

// With a margin of zeros, so that no pixel needs to know of the border.
Image<float> withMargin(const Image<float>& image, int margin) {
  Image<float> result(image.width() + 2 * margin + kVectorLanes, image.height() + 2 * margin);
  for (int y = 0; y < image.height(); ++y)
    std::copy_n(image.row(y), image.width(), result.row(y + margin) + margin);
  return result;
}

}  // namespace

PlaneMap planeFitted(const Image<float>& inverse_depth, const Image<float>& weight,
                     const PlaneFitOptions& options) {
  const int radius = options.radius, width = inverse_depth.width(), height = inverse_depth.height();
  const Image<float> values = withMargin(inverse_depth, radius), weights = withMargin(weight, radius);
  const PlaneRows rows{values.data(),       weights.data(), values.width(), radius,
                       options.first_scale, options.scale,  options.rounds};
  PlaneMap result{{width, height}, {width, height}, {width, height}, {width, height}};
  parallelFor(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    const auto count = static_cast<std::size_t>(width);
    std::vector<float> memory(4 * (count + kVectorLanes));
    PlaneLines lines{};
    for (std::size_t k = 0; k < lines.size(); ++k) lines[k] = memory.data() + k * (count + kVectorLanes);
    Image<float>* const images[] = {&result.value, &result.dx, &result.dy, &result.share};
    for (std::size_t y = begin; y < end; ++y) {
      const std::size_t at = (y + static_cast<std::size_t>(radius)) * static_cast<std::size_t>(rows.stride) +
                             static_cast<std::size_t>(radius);
      HWY_DYNAMIC_DISPATCH(fitRow)(rows, at, count, lines);
      for (std::size_t k = 0; k < lines.size(); ++k)
        std::copy_n(lines[k], count, images[k]->row(static_cast<int>(y)));
    }
  });
  return result;
}

}  // namespace vdbfuse::stereo
#endif
