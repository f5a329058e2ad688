// SPDX-License-Identifier: Apache-2.0
#include "stereo/vote_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/vote_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse::stereo {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kVectorLanes>;
using FloatVec = hn::Vec<Floats>;
HWY_INLINE FloatVec set(float value) { return hn::Set(Floats(), value); }

// exp(−d²/2σ²) up to 4σ, 0 beyond: the eighth power of exp(−u), u = d²/16σ² in [0, 1], by a polynomial
// (interpolated at five Chebyshev nodes). Off by less than 1e-6.
class Gaussian {
 public:
  explicit Gaussian(float sigma) : scale_(set(1 / (16 * sigma * sigma))) {}
  HWY_INLINE FloatVec at(FloatVec distance) const {
    const FloatVec u = hn::Mul(hn::Mul(distance, distance), scale_);
    FloatVec root = set(-0.005547933F);
    for (const float term : {0.03940637F, -0.16588657F, 0.49990399F, -0.99999809F, 1.0F})
      root = hn::MulAdd(root, u, set(term));
    const FloatVec second = hn::Mul(root, root), fourth = hn::Mul(second, second);
    return hn::IfThenElseZero(hn::Lt(u, set(1.0F)), hn::Mul(fourth, fourth));
  }

 private:
  FloatVec scale_;
};

// Those who vote in a vector of pixels, one after the other.
class Ballot {
 public:
  explicit Ballot(float* memory) : memory_(memory) {}
  std::size_t size() const { return size_; }
  std::size_t partners() const { return partners_; }
  HWY_INLINE FloatVec step(std::size_t j) const { return get(j, 0); }
  HWY_INLINE FloatVec score(std::size_t j) const { return get(j, 1); }
  HWY_INLINE FloatVec pull(std::size_t j) const { return get(j, 2); }  // score · curvature
  HWY_INLINE FloatVec count(std::size_t j) const { return get(j, 3); }
  HWY_INLINE void setCount(std::size_t j, FloatVec c) const { hn::Store(c, Floats(), row(j, 3)); }

  HWY_INLINE void fill(std::span<const VoterRows> voters, std::size_t partners, std::size_t pixel) {
    const Floats d;
    size_ = partners_ = 0;
    for (std::size_t j = 0; j < voters.size(); ++j) {
      const FloatVec found = hn::Load(d, voters[j].score + pixel);
      const auto votes = hn::Gt(found, set(0.0F));
      if (hn::AllFalse(d, votes)) continue;
      const FloatVec curvature = hn::Load(d, voters[j].curvature + pixel);
      hn::Store(hn::IfThenElseZero(votes, hn::Load(d, voters[j].step + pixel)), d, row(size_, 0));
      hn::Store(hn::IfThenElseZero(votes, found), d, row(size_, 1));
      hn::Store(hn::IfThenElseZero(votes, hn::Mul(found, curvature)), d, row(size_, 2));
      ++size_;
      if (j < partners) ++partners_;
    }
  }

 private:
  HWY_INLINE float* row(std::size_t j, std::size_t field) const {
    return memory_ + (4 * j + field) * hn::Lanes(Floats());
  }
  HWY_INLINE FloatVec get(std::size_t j, std::size_t field) const {
    return hn::Load(Floats(), row(j, field));
  }

  float* memory_;
  std::size_t size_ = 0, partners_ = 0;
};

// C at every voter's step; 0 where a pixel has no such voter.
HWY_INLINE void countAll(const Ballot& ballot, const Gaussian& gaussian) {
  for (std::size_t j = 0; j < ballot.size(); ++j) ballot.setCount(j, ballot.score(j));
  for (std::size_t i = 0; i < ballot.size(); ++i) {
    const FloatVec step = ballot.step(i), score = ballot.score(i);
    FloatVec count = ballot.count(i);
    for (std::size_t j = i + 1; j < ballot.size(); ++j) {
      const FloatVec weight = gaussian.at(hn::Sub(step, ballot.step(j)));
      count = hn::MulAdd(weight, ballot.score(j), count);
      ballot.setCount(j, hn::MulAdd(weight, score, ballot.count(j)));
    }
    ballot.setCount(i, hn::IfThenElseZero(hn::Gt(score, set(0.0F)), count));
  }
}

struct Candidate {
  FloatVec step, index;
};
HWY_INLINE Candidate bestOf(const Ballot& ballot) {
  FloatVec best = set(0.0F);
  Candidate candidate{set(0.0F), set(-1.0F)};
  for (std::size_t j = 0; j < ballot.size(); ++j) {
    const FloatVec count = ballot.count(j);
    const auto better = hn::Gt(count, best);
    best = hn::Max(count, best);
    candidate.step = hn::IfThenElse(better, ballot.step(j), candidate.step);
    candidate.index = hn::IfThenElse(better, set(static_cast<float>(j)), candidate.index);
  }
  return candidate;
}

HWY_INLINE FloatVec shifted(const Ballot& ballot, const Gaussian& gaussian, FloatVec step) {
  constexpr int kShifts = 4;
  for (int k = 0; k < kShifts; ++k) {
    FloatVec sum = set(0.0F), place = set(0.0F);
    for (std::size_t j = 0; j < ballot.size(); ++j) {
      const FloatVec at = ballot.step(j);
      const FloatVec pull = hn::Mul(ballot.pull(j), gaussian.at(hn::Sub(at, step)));
      sum = hn::Add(sum, pull), place = hn::MulAdd(pull, at, place);
    }
    step = hn::IfThenElse(hn::Gt(sum, set(0.0F)), hn::Div(place, sum), step);
  }
  return step;
}

// The fields of a mode at `step`.
HWY_INLINE void describe(const Ballot& ballot, const Gaussian& gaussian, float sigma, FloatVec step,
                         std::size_t pixel, ModeRows& modes) {
  const Floats d;
  const FloatVec zero = set(0.0F);
  FloatVec score = zero, support = zero, voters = zero, spread2 = zero, weights = zero;
  for (std::size_t j = 0; j < ballot.partners(); ++j) {
    const FloatVec distance = hn::Sub(ballot.step(j), step);
    const FloatVec vote = hn::Mul(ballot.score(j), gaussian.at(distance));
    score = hn::Add(score, vote);
    const auto near = hn::And(hn::Gt(vote, zero), hn::Le(hn::Abs(distance), set(2 * sigma)));
    const FloatVec weight = hn::IfThenElseZero(near, vote);
    voters = hn::Add(voters, hn::IfThenElseZero(near, set(1.0F)));
    spread2 = hn::MulAdd(weight, hn::Mul(distance, distance), spread2), weights = hn::Add(weights, weight);
  }
  for (std::size_t j = ballot.partners(); j < ballot.size(); ++j)
    support = hn::MulAdd(ballot.score(j), gaussian.at(hn::Sub(ballot.step(j), step)), support);
  hn::Store(step, d, modes.step.data() + pixel);
  hn::Store(score, d, modes.score.data() + pixel);
  hn::Store(support, d, modes.support.data() + pixel);
  hn::Store(hn::IfThenElseZero(hn::Gt(weights, zero), hn::Div(spread2, weights)), d,
            modes.spread2.data() + pixel);
  hn::Store(hn::ConvertTo(hn::RebindToSigned<Floats>(), voters), hn::RebindToSigned<Floats>(),
            modes.voters.data() + pixel);
}

HWY_INLINE FloatVec secondOf(const Ballot& ballot, float sigma, FloatVec step, FloatVec best_index) {
  FloatVec second = set(0.0F);
  for (std::size_t j = 0; j < ballot.size(); ++j) {
    const auto apart = hn::Ge(hn::Abs(hn::Sub(ballot.step(j), step)), set(3 * sigma));
    const auto other = hn::Ne(best_index, set(static_cast<float>(j)));
    second = hn::Max(second, hn::IfThenElseZero(hn::And(apart, other), ballot.count(j)));
  }
  return second;
}

HWY_INLINE void clear(std::size_t pixel, ModeRows& modes) {
  for (AlignedFloats* row : {&modes.step, &modes.score, &modes.support, &modes.spread2, &modes.second})
    hn::Store(set(0.0F), Floats(), row->data() + pixel);
  const hn::RebindToSigned<Floats> di;
  hn::Store(hn::Zero(di), di, modes.voters.data() + pixel);
}

void count(std::span<const VoterRows> voters, std::size_t partners, float sigma, std::size_t pixels,
           ModeRows& modes) {
  const Gaussian gaussian(sigma);
  Ballot ballot(modes.memory.data());
  for (std::size_t i = 0; i < pixels; i += hn::Lanes(Floats())) {
    ballot.fill(voters, partners, i);
    if (ballot.size() == 0) {
      clear(i, modes);
      continue;
    }
    countAll(ballot, gaussian);
    const Candidate best = bestOf(ballot);
    const FloatVec step = shifted(ballot, gaussian, best.step);
    describe(ballot, gaussian, sigma, step, i, modes);
    hn::Store(secondOf(ballot, sigma, step, best.index), Floats(), modes.second.data() + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse::stereo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse::stereo {

HWY_EXPORT(count);

void countVotes(std::span<const VoterRows> voters, std::size_t partners, float sigma, std::size_t pixels,
                ModeRows& modes) {
  for (AlignedFloats* row : {&modes.step, &modes.score, &modes.support, &modes.spread2, &modes.second})
    row->resize(pixels);
  modes.voters.resize(pixels);
  modes.memory.resize(4 * kVectorLanes * voters.size());
  HWY_DYNAMIC_DISPATCH(count)(voters, partners, sigma, pixels, modes);
}

}  // namespace vdbfuse::stereo
#endif
