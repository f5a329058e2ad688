// SPDX-License-Identifier: Apache-2.0
#include "stereo/vote_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stereo/vote_kernels.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
// after it:
#include <hwy/highway.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace vdbfuse::stereo {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kVectorLanes>;
using FloatVec = hn::Vec<Floats>;
using FloatMask = hn::Mask<Floats>;
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

// The peaks in a vector of pixels, one after the other.
class Ballot {
 public:
  explicit Ballot(std::size_t rows) : memory_(4 * kVectorLanes * rows), voters_(rows) {}
  std::size_t size() const { return size_; }
  bool isPartner(std::size_t i) const { return i < partners_; }
  bool haveSameVoter(std::size_t i, std::size_t j) const { return voters_[i] == voters_[j]; }
  bool hasLists() const { return has_lists_; }
  HWY_INLINE FloatVec step(std::size_t i) const { return get(i, 0); }
  HWY_INLINE FloatVec score(std::size_t i) const { return get(i, 1); }
  HWY_INLINE FloatVec curvature(std::size_t i) const { return get(i, 2); }
  HWY_INLINE FloatVec count(std::size_t i) const { return get(i, 3); }  // C at the peak; 0: no candidate
  HWY_INLINE void setCount(std::size_t i, FloatVec c) { hn::Store(c, Floats(), row(i, 3)); }

  // Leaves out those that no pixel has.
  HWY_INLINE void fill(std::span<const VoterRows> rows, std::size_t partners, std::size_t pixel) {
    const Floats d;
    size_ = partners_ = 0;
    has_lists_ = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const FloatVec found = hn::Load(d, rows[i].score + pixel);
      const auto votes = hn::Gt(found, set(0.0F));
      if (hn::AllFalse(d, votes)) continue;
      hn::Store(hn::IfThenElseZero(votes, hn::Load(d, rows[i].step + pixel)), d, row(size_, 0));
      hn::Store(hn::IfThenElseZero(votes, found), d, row(size_, 1));
      hn::Store(hn::IfThenElseZero(votes, hn::Load(d, rows[i].curvature + pixel)), d, row(size_, 2));
      voters_[size_] = rows[i].voter;
      if (size_ > 0 && haveSameVoter(size_ - 1, size_)) has_lists_ = true;
      ++size_;
      if (i < partners) ++partners_;
    }
  }

 private:
  HWY_INLINE float* row(std::size_t i, std::size_t field) {
    return memory_.data() + (4 * i + field) * hn::Lanes(Floats());
  }
  HWY_INLINE FloatVec get(std::size_t i, std::size_t field) const {
    return hn::Load(Floats(), memory_.data() + (4 * i + field) * hn::Lanes(Floats()));
  }

  AlignedFloats memory_;
  std::vector<int> voters_;
  std::size_t size_ = 0, partners_ = 0;
  bool has_lists_ = false;
};

struct Vote {
  FloatVec weighted;  // S·W
  FloatVec step, curvature;
};

// Calls use(vote, whether it is a partner's) for the best peak of every voter near `step`, the first of
// equals.
template <class Use>
HWY_INLINE void forEachVoter(const Ballot& ballot, const Gaussian& gaussian, FloatVec step, const Use& use) {
  const auto vote_of = [&](std::size_t i) HWY_ATTR {
    const FloatVec at = ballot.step(i);
    return Vote{hn::Mul(ballot.score(i), gaussian.at(hn::Sub(at, step))), at, ballot.curvature(i)};
  };
  for (std::size_t i = 0; i < ballot.size();) {
    const std::size_t first = i;
    Vote best = vote_of(i);
    for (++i; i < ballot.size() && ballot.haveSameVoter(first, i); ++i) {
      const Vote other = vote_of(i);
      const auto is_better = hn::Gt(other.weighted, best.weighted);
      best = {hn::Max(other.weighted, best.weighted), hn::IfThenElse(is_better, other.step, best.step),
              hn::IfThenElse(is_better, other.curvature, best.curvature)};
    }
    use(best, ballot.isPartner(first));
  }
}

HWY_INLINE void setCountOfPeaks(Ballot& ballot, std::size_t i, FloatVec count) {
  ballot.setCount(i, hn::IfThenElseZero(hn::Gt(ballot.score(i), set(0.0F)), count));
}

// C at every peak, where voters have several.
HWY_INLINE void countLists(Ballot& ballot, const Gaussian& gaussian) {
  for (std::size_t i = 0; i < ballot.size(); ++i) {
    FloatVec count = set(0.0F);
    forEachVoter(ballot, gaussian, ballot.step(i),
                 [&](const Vote& vote, bool) HWY_ATTR { count = hn::Add(count, vote.weighted); });
    setCountOfPeaks(ballot, i, count);
  }
}

// The same where each has one: half the weights.
HWY_INLINE void countPairs(Ballot& ballot, const Gaussian& gaussian) {
  for (std::size_t i = 0; i < ballot.size(); ++i) ballot.setCount(i, ballot.score(i));
  for (std::size_t i = 0; i < ballot.size(); ++i) {
    const FloatVec step = ballot.step(i), score = ballot.score(i);
    FloatVec count = ballot.count(i);
    for (std::size_t j = i + 1; j < ballot.size(); ++j) {
      const FloatVec weight = gaussian.at(hn::Sub(step, ballot.step(j)));
      count = hn::MulAdd(weight, ballot.score(j), count);
      ballot.setCount(j, hn::MulAdd(weight, score, ballot.count(j)));
    }
    setCountOfPeaks(ballot, i, count);
  }
}

struct Candidate {
  FloatVec count, step, index;
};
HWY_INLINE Candidate bestOf(const Ballot& ballot) {
  Candidate best{set(0.0F), set(0.0F), set(-1.0F)};
  for (std::size_t i = 0; i < ballot.size(); ++i) {
    const FloatVec count = ballot.count(i);
    const auto is_better = hn::Gt(count, best.count);
    best = {hn::Max(count, best.count), hn::IfThenElse(is_better, ballot.step(i), best.step),
            hn::IfThenElse(is_better, set(static_cast<float>(i)), best.index)};
  }
  return best;
}

HWY_INLINE FloatVec shifted(const Ballot& ballot, const Gaussian& gaussian, FloatVec step) {
  constexpr int kShifts = 4;
  for (int k = 0; k < kShifts; ++k) {
    FloatVec sum = set(0.0F), place = set(0.0F);
    forEachVoter(ballot, gaussian, step, [&](const Vote& vote, bool) HWY_ATTR {
      const FloatVec pull = hn::Mul(vote.weighted, vote.curvature);
      sum = hn::Add(sum, pull), place = hn::MulAdd(pull, vote.step, place);
    });
    step = hn::IfThenElse(hn::Gt(sum, set(0.0F)), hn::Div(place, sum), step);
  }
  return step;
}

// Without `second`.
HWY_INLINE void store(const Ballot& ballot, const Gaussian& gaussian, float sigma, FloatVec step,
                      FloatMask is_some, std::size_t pixel, ModeRows& mode) {
  const Floats d;
  const hn::RebindToSigned<Floats> di;
  const FloatVec zero = set(0.0F);
  FloatVec score = zero, support = zero, voters = zero, spread2 = zero, weights = zero;
  forEachVoter(ballot, gaussian, step, [&](const Vote& vote, bool is_partner) HWY_ATTR {
    if (!is_partner) {
      support = hn::Add(support, vote.weighted);
      return;
    }
    score = hn::Add(score, vote.weighted);
    const FloatVec distance = hn::Sub(vote.step, step);
    const auto is_near = hn::And(hn::Gt(vote.weighted, zero), hn::Le(hn::Abs(distance), set(2 * sigma)));
    const FloatVec weight = hn::IfThenElseZero(is_near, vote.weighted);
    voters = hn::Add(voters, hn::IfThenElseZero(is_near, set(1.0F)));
    spread2 = hn::MulAdd(weight, hn::Mul(distance, distance), spread2), weights = hn::Add(weights, weight);
  });
  const auto put = [&](FloatVec value, AlignedFloats& row)
                       HWY_ATTR { hn::Store(hn::IfThenElseZero(is_some, value), d, row.data() + pixel); };
  put(step, mode.step), put(score, mode.score), put(support, mode.support);
  put(hn::IfThenElseZero(hn::Gt(weights, zero), hn::Div(spread2, weights)), mode.spread2);
  hn::Store(hn::ConvertTo(di, hn::IfThenElseZero(is_some, voters)), di, mode.voters.data() + pixel);
}

// Near a mode, or the peak that it began at, there is no other.
HWY_INLINE void leaveOut(Ballot& ballot, float sigma, FloatVec step, FloatVec index) {
  for (std::size_t i = 0; i < ballot.size(); ++i) {
    const auto is_apart = hn::Ge(hn::Abs(hn::Sub(ballot.step(i), step)), set(3 * sigma));
    const auto is_other = hn::Ne(index, set(static_cast<float>(i)));
    ballot.setCount(i, hn::IfThenElseZero(hn::And(is_apart, is_other), ballot.count(i)));
  }
}

HWY_INLINE void clear(std::size_t pixel, ModeRows& mode) {
  for (AlignedFloats* row : {&mode.step, &mode.score, &mode.support, &mode.second, &mode.spread2})
    hn::Store(set(0.0F), Floats(), row->data() + pixel);
  const hn::RebindToSigned<Floats> di;
  hn::Store(hn::Zero(di), di, mode.voters.data() + pixel);
}

void count(std::span<const VoterRows> rows, std::size_t partners, float sigma, std::size_t pixels,
           std::span<ModeRows> modes) {
  const Floats d;
  const Gaussian gaussian(sigma);
  Ballot ballot(rows.size());
  for (std::size_t pixel = 0; pixel < pixels; pixel += hn::Lanes(d)) {
    ballot.fill(rows, partners, pixel);
    if (ballot.hasLists())
      countLists(ballot, gaussian);
    else
      countPairs(ballot, gaussian);
    Candidate best = bestOf(ballot);
    for (ModeRows& mode : modes) {
      const auto is_some = hn::Gt(best.count, set(0.0F));
      if (hn::AllFalse(d, is_some)) {
        clear(pixel, mode);
        continue;
      }
      const FloatVec step = shifted(ballot, gaussian, best.step);
      store(ballot, gaussian, sigma, step, is_some, pixel, mode);
      leaveOut(ballot, sigma, step, best.index);
      best = bestOf(ballot);
      hn::Store(best.count, d, mode.second.data() + pixel);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace vdbfuse::stereo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbfuse::stereo {

HWY_EXPORT(count);

void countVotes(std::span<const VoterRows> rows, std::size_t partners, float sigma, std::size_t pixels,
                std::span<ModeRows> modes) {
  for (ModeRows& mode : modes) {
    for (AlignedFloats* row : {&mode.step, &mode.score, &mode.support, &mode.second, &mode.spread2})
      row->resize(pixels);
    mode.voters.resize(pixels);
  }
  HWY_DYNAMIC_DISPATCH(count)(rows, partners, sigma, pixels, modes);
}

}  // namespace vdbfuse::stereo
#endif
