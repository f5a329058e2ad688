// SPDX-License-Identifier: Apache-2.0
// 1/x and 1/√x to the last bits but one or two: a guess of the processor and a step of Newton's method,
// several times as fast as its division. REQUIRES: x > 0, neither tiny nor huge. Included once for each
// instruction set.
#if defined(VDBFUSE_STEREO_RECIPROCALS) == defined(HWY_TARGET_TOGGLE)
#ifdef VDBFUSE_STEREO_RECIPROCALS
#undef VDBFUSE_STEREO_RECIPROCALS
#else
#define VDBFUSE_STEREO_RECIPROCALS
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse::stereo {
namespace HWY_NAMESPACE {

template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V reciprocal(D d, V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const V guess = hn::ApproximateReciprocal(x);
  return hn::MulAdd(guess, hn::NegMulAdd(x, guess, hn::Set(d, 1.0F)), guess);
}

template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE V reciprocalRoot(D d, V x) {
  namespace hn = hwy::HWY_NAMESPACE;
  const V guess = hn::ApproximateReciprocalSqrt(x);
  const V half = hn::Mul(hn::Mul(x, hn::Set(d, 0.5F)), guess);
  return hn::Mul(guess, hn::NegMulAdd(half, guess, hn::Set(d, 1.5F)));
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse::stereo
HWY_AFTER_NAMESPACE();

#endif
