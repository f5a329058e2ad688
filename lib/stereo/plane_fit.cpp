// SPDX-License-Identifier: Apache-2.0
#include "stereo/plane_fit.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/plane_fit.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>

#include "stereo/plane_rows.h"
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

// Sums of the normal equations.
struct Moments {
  FloatVec w, x, y, xx, xy, yy, v, vx, vy;

  HWY_INLINE void add(FloatVec weight, FloatVec value, float dx, float dy) {
    const FloatVec wx = hn::Mul(weight, set(dx)), wy = hn::Mul(weight, set(dy)), wv = hn::Mul(weight, value);
    w = hn::Add(w, weight), x = hn::Add(x, wx), y = hn::Add(y, wy);
    xx = hn::MulAdd(wx, set(dx), xx), xy = hn::MulAdd(wx, set(dy), xy), yy = hn::MulAdd(wy, set(dy), yy);
    v = hn::Add(v, wv), vx = hn::MulAdd(wv, set(dx), vx), vy = hn::MulAdd(wv, set(dy), vy);
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
  const FloatVec zero = hn::Zero(d);
  Moments moments{zero, zero, zero, zero, zero, zero, zero, zero, zero};
  const FloatVec sharpness = set(1 / (scale * scale));
  const int radius = rows.radius;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const auto shift = static_cast<std::ptrdiff_t>(dy) * rows.stride + dx;
      const FloatVec value = hn::Sub(hn::LoadU(d, rows.value + at + shift), middle);
      const auto fx = static_cast<float>(dx), fy = static_cast<float>(dy);
      const FloatVec expected = hn::MulAdd(plane.b, set(fx), hn::MulAdd(plane.c, set(fy), plane.a));
      const FloatVec off = hn::Sub(value, expected);
      const FloatVec far = hn::MulAdd(hn::Mul(off, off), sharpness, set(1.0F));
      moments.add(hn::Div(hn::LoadU(d, rows.weight + at + shift), hn::Mul(far, far)), value, fx, fy);
    }
  }
  return moments;
}

void fitRow(const PlaneRows& rows, std::size_t at, std::size_t count, float* result) {
  const Floats d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const FloatVec middle = hn::LoadU(d, rows.value + at + i);
    const FloatVec weight = hn::LoadU(d, rows.weight + at + i);
    if (hn::AllTrue(d, hn::Eq(weight, set(0.0F)))) {
      hn::StoreU(set(0.0F), d, result + i);
      continue;
    }
    Plane plane{set(0.0F), set(0.0F), set(0.0F)};
    float scale = rows.first_scale;
    for (int round = 0; round < rows.rounds; ++round) {
      plane = gather(rows, at + i, middle, plane, scale).solve();
      scale = std::max(rows.scale, 0.5F * scale);
    }
    hn::StoreU(hn::IfThenElseZero(hn::Gt(weight, set(0.0F)), hn::Add(middle, plane.a)), d, result + i);
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

Image<float> planeFitted(const Image<float>& inverse_depth, const Image<float>& weight,
                         const PlaneFitOptions& options) {
  const int radius = options.radius, width = inverse_depth.width(), height = inverse_depth.height();
  const Image<float> values = withMargin(inverse_depth, radius), weights = withMargin(weight, radius);
  const PlaneRows rows{values.data(),       weights.data(), values.width(), radius,
                       options.first_scale, options.scale,  options.rounds};
  Image<float> result(width, height);
  parallelFor(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> line(static_cast<std::size_t>(width + kVectorLanes));
    for (std::size_t y = begin; y < end; ++y) {
      const std::size_t at = (y + static_cast<std::size_t>(radius)) * static_cast<std::size_t>(rows.stride) +
                             static_cast<std::size_t>(radius);
      HWY_DYNAMIC_DISPATCH(fitRow)(rows, at, static_cast<std::size_t>(width), line.data());
      std::copy_n(line.data(), width, result.row(static_cast<int>(y)));
    }
  });
  return result;
}

}  // namespace vdbfuse::stereo
#endif
