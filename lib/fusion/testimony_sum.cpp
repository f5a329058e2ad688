// SPDX-License-Identifier: Apache-2.0
#include "fusion/testimony_sum.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/fusion/likelihood.h"

namespace vdbfuse {
namespace {

// The first view's worth of masks counts no more than a no-return at its best (L = 3): against two views or
// more that deny a point that is not enough, so that one wrong mask, or any number of copies of it, cannot
// carve alone.
constexpr float kUnconfirmedMasks = 1.0f, kUnconfirmedMask = 1.0986123f;

// log(1 + e^x)
float softplus(float x) { return x > 30 ? x : std::log1p(std::exp(x)); }

// What is measured outside the silhouette is not heard.
BlockTestimony hear(const PreparedView& prepared, const LikelihoodRatio& ratio, float thickness,
                    const BlockLook& seen, std::size_t size) {
  BlockTestimony said = testify(prepared, ratio, thickness, seen, size);
  if (!prepared.has_mask) return said;
  for (std::size_t i = 0; i < size; ++i) {
    if (seen.pixel[i] >= 0 && prepared.view->look.data()[seen.pixel[i]] == Look::Outside)
      said.share[i] = said.log_ratio[i] = 0.0f;
  }
  return said;
}

Measurement measurementAt(const PreparedView& prepared, std::size_t pixel) {
  Measurement result(0, 1, prepared.view->outlier.data()[pixel]);
  result.count = 0;
  forEachHypothesis(prepared, pixel, [&](float depth, float share) {
    result.hypotheses[result.count++] = {depth, prepared.noise.at(depth), share};
  });
  return result;
}

}  // namespace

TestimonySums TestimonySums::part(std::size_t first, std::size_t count) const {
  const std::size_t per_point = nodes.size() / reports.size();
  return {nodes.subspan(first * per_point, count * per_point), reports.subspan(first, count),
          heard.subspan(first, count), empties.subspan(first, count), masked.subspan(first, count)};
}

TestimonySum::TestimonySum(const SensorModel& sensor, double miss_rate, const EvidenceOptions& options,
                           double total_weight)
    : options_(options),
      sensor_(sensor),
      ratio_(sensor),
      integral_(options.visibility_prior, options.rule == EvidenceRule::Outside ? options.visibility : 1.0,
                total_weight),
      no_return_(static_cast<float>(logNoReturnRatio(miss_rate))),
      mask_(static_cast<float>(logMaskRatio(options.mask_error))),
      thickness_(options.rule == EvidenceRule::Outside ? static_cast<float>(options.thickness) : 0.0f) {}

void TestimonySum::add(const PreparedView& view, const PointBlock& block, float weight,
                       const TestimonySums& sums) const {
  if (!view.projector.mightSee(block.centre, block.radius)) return;
  switch (options_.rule) {
    case EvidenceRule::Outside:
      return addOutside(view, block, weight, sums);
    case EvidenceRule::Paper:
      return addPaper(view, block, weight, sums);
    case EvidenceRule::NoSelfOcclusion:
      return addNoSelfOcclusion(view, block, weight, sums);
    case EvidenceRule::Constant:
      return;
  }
}

void TestimonySum::addOutside(const PreparedView& prepared, const PointBlock& block, float weight,
                              const TestimonySums& sums) const {
  const BlockLook seen = look(prepared, block);
  const BlockTestimony said = hear(prepared, ratio_, thickness_, seen, block.size);
  accumulate(integral_, said, weight, block.size, sums.nodes.data());
  for (std::size_t i = 0; i < block.size; ++i) {
    sums.reports[i] += weight * said.share[i];
    sums.heard[i] += said.share[i] > 0 ? weight : 0.0f;
  }
  if (!prepared.has_looks) return;
  for (std::size_t i = 0; i < block.size; ++i) {
    if (seen.pixel[i] < 0 || said.share[i] != 0) continue;
    const Look look = prepared.view->look.data()[seen.pixel[i]];
    if (look == Look::Empty) sums.empties[i] += weight;
    if (look == Look::Outside) sums.masked[i] += weight;
  }
}

// Equation (5) needs log Π π_i, π = 1/(1 + odds). Each view counts whole.
void TestimonySum::addPaper(const PreparedView& prepared, const PointBlock& block, float weight,
                            const TestimonySums& sums) const {
  const BlockLook seen = look(prepared, block);
  const BlockTestimony said = hear(prepared, ratio_, thickness_, seen, block.size);
  const float sign = weight > 0 ? 1.0f : -1.0f;
  for (std::size_t i = 0; i < block.size; ++i) {
    const bool masked = seen.pixel[i] >= 0 && prepared.view->look.data()[seen.pixel[i]] == Look::Outside;
    if (said.share[i] == 0 && !masked) continue;
    const float t = (ratio_.clampDepth(seen.depth[i]) - ratio_.near()) * ratio_.perRange();
    sums.nodes[i] -= sign * softplus(std::log((1 - t) / t) + (masked ? mask_ : said.log_ratio[i]));
    sums.reports[i] += sign;
  }
}

// Equation (10), without a table: what it is compared with is exact.
void TestimonySum::addNoSelfOcclusion(const PreparedView& prepared, const PointBlock& block, float weight,
                                      const TestimonySums& sums) const {
  for (std::size_t i = 0; i < block.size; ++i) {
    const std::optional<Sighting> seen = prepared.projector(block.point(i));
    if (!seen) continue;
    if (prepared.view->look(seen->x, seen->y) == Look::Outside) {
      sums.masked[i] += weight;
      continue;
    }
    if (prepared.view->depth(seen->x, seen->y) == kInvalidDepth) continue;
    const std::size_t pixel = static_cast<std::size_t>(seen->y * prepared.view->depth.width() + seen->x);
    sums.nodes[i] +=
        weight * static_cast<float>(logVisibleOdds(sensor_, measurementAt(prepared, pixel), seen->depth));
    sums.reports[i] += weight;
  }
}

void TestimonySum::finishOutside(const TestimonySums& sums, float* evidence) const {
  const std::size_t count = sums.reports.size();
  std::vector<float> nodes(sums.nodes.begin(), sums.nodes.end());
  for (std::size_t i = 0; i < count; ++i) {
    float* const node = &nodes[i * nodeCount()];
    const float empties = std::min(sums.empties[i], static_cast<float>(options_.max_no_returns));
    if (empties > 0) integral_.add(no_return_, empties, node);
    const float masked = sums.masked[i], unconfirmed = std::min(masked, kUnconfirmedMasks);
    if (masked > 0) integral_.add(std::min(mask_, kUnconfirmedMask), unconfirmed, node);
    if (masked > unconfirmed) integral_.add(mask_, masked - unconfirmed, node);
  }
  logMeans(integral_, nodes.data(), count, evidence);
  for (std::size_t i = 0; i < count; ++i) {
    evidence[i] += static_cast<float>(std::min(options_.prior, integral_.halfDenial(sums.reports[i])));
    if (evidence[i] < 0) evidence[i] *= sums.reports[i] / std::max(sums.heard[i], sums.reports[i] + 1e-6f);
  }
}

// Without self-occlusion a view that leaves the point out counts with its whole ratio, but for the first one.
float TestimonySum::maskTerm(float masked) const {
  const float unconfirmed = std::min(masked, kUnconfirmedMasks);
  return unconfirmed * std::min(mask_, kUnconfirmedMask) + (masked - unconfirmed) * mask_;
}

void TestimonySum::finish(const TestimonySums& sums, float* evidence) const {
  const std::size_t count = sums.reports.size();
  switch (options_.rule) {
    case EvidenceRule::Outside:
      return finishOutside(sums, evidence);
    case EvidenceRule::Paper:
      for (std::size_t i = 0; i < count; ++i) {
        const double hidden = static_cast<double>(sums.nodes[i]);
        evidence[i] = static_cast<float>(sums.reports[i] > 0.5f ? std::log(-std::expm1(hidden)) - hidden
                                                                : options_.prior);
      }
      return;
    case EvidenceRule::NoSelfOcclusion:
      for (std::size_t i = 0; i < count; ++i) evidence[i] = sums.nodes[i] + maskTerm(sums.masked[i]);
      return;
    case EvidenceRule::Constant:
      std::fill_n(evidence, count, static_cast<float>(-options_.balloon));
      return;
  }
}

}  // namespace vdbfuse
