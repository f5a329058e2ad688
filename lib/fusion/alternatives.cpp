// SPDX-License-Identifier: Apache-2.0
#include "fusion/alternatives.h"

#include <algorithm>

namespace vdbfuse {
namespace {

double odds(double outlier) {
  const double e = std::clamp<double>(outlier, kMinOutlier, kMaxOutlier);
  return (1 - e) / e;
}

}  // namespace

AlternativeViews::AlternativeViews(std::vector<View>& views) : of_(views.size()) {
  for (std::size_t i = 0; i < of_.size(); ++i) {
    for (std::size_t k = 0; k < views[i].map.alternatives.size(); ++k) {
      View layer;
      static_cast<ViewHeader&>(layer) = views[i];
      layer.map.depth = std::move(views[i].map.alternatives[k].depth);
      of_[i].push_back(views.size());
      views.push_back(std::move(layer));
    }
  }
}

void AlternativeViews::extend(std::vector<std::vector<std::size_t>>& neighbours) const {
  for (std::size_t i = 0; i < of_.size(); ++i) {
    const std::vector<std::size_t> parents = neighbours[i];
    neighbours.insert(neighbours.end(), of_[i].size(), parents);
  }
}

void AlternativeViews::restore(std::vector<View>& views) const {
  for (std::size_t i = 0; i < of_.size(); ++i) {
    for (std::size_t k = 0; k < of_[i].size(); ++k)
      views[i].map.alternatives[k].depth = std::move(views[of_[i][k]].map.depth);
  }
  views.resize(of_.size());
}

void weighAlternatives(const AlternativeViews& alternatives, std::size_t index,
                       const Testimonies& testimonies, const Image<std::uint8_t>& confidence,
                       const ReliabilityTable& table, const std::vector<CompactSurface>& surfaces,
                       JudgedView& view) {
  const std::vector<std::size_t>& layers = alternatives.of()[index];
  if (layers.empty()) return;
  for (std::size_t p = 0; p < view.depth.size(); ++p) {
    if (view.depth.data()[p] == kInvalidDepth) continue;
    double left = 1, total = 0;
    std::size_t best = layers.size();
    std::array<double, 3> weights{};
    for (std::size_t k = 0; k < layers.size(); ++k) {
      const DepthAlternative& other = view.alternatives[k];
      const double share = std::clamp<double>(other.share.data()[p], 0.0, left);
      if (other.depth.data()[p] == kInvalidDepth) continue;
      left -= share;
      const std::size_t c = confidence.empty() ? 0 : confidence.data()[p];
      weights[k] = share * odds(table.outlier(c, testimonies.views[layers[k]].data()[p]));
      total += weights[k];
    }
    const double main = left * odds(view.outlier.data()[p]);
    total += main;
    double largest = main;
    for (std::size_t k = 0; k < layers.size(); ++k) {
      view.alternatives[k].share.data()[p] = static_cast<float>(weights[k] / total);
      if (weights[k] > largest) largest = weights[k], best = k;
    }
    view.outlier.data()[p] = std::clamp(static_cast<float>(1 / (1 + total)), kMinOutlier, kMaxOutlier);
    if (best == layers.size()) continue;
    std::swap(view.depth.data()[p], view.alternatives[best].depth.data()[p]);
    view.alternatives[best].share.data()[p] = static_cast<float>(main / total);
    view.incidence.data()[p] = surfaces[layers[best]].incidence.data()[p];
  }
}

}  // namespace vdbfuse
