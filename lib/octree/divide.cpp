// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/divide.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/octree/cell_faces.h"

namespace vdbfuse {
namespace {

constexpr double kFacesOfACube = 6.0;
// Between the samples of a cell evidence may be weaker than at any of them.
constexpr double kSampling = 2.0;
constexpr double kMatters = 1.0;

}  // namespace

bool isDecided(double side, float weakest_evidence, float support, const DivideOptions& options) {
  const double evidence = std::min<double>(std::abs(weakest_evidence), options.max_evidence);
  return support == 0.0f && options.lambda * evidence * side >= kSampling * kFacesOfACube;
}

std::vector<std::size_t> cellsToDivide(const Octree& octree, const CellTiles& tiles,
                                       const std::vector<float>& support, const CellEvidence& evidence,
                                       const DivideOptions& options) {
  const double h = octree.frame.voxel;
  const auto matters = [&](std::uint32_t cell, float other) {
    if (octree.levels[cell] == 0) return false;
    const double side = h * octree.side(cell);
    const double weaker = std::min(std::abs(evidence.mean[cell]), std::abs(other));
    return options.lambda * weaker * side >= kMatters &&
           !isDecided(side, evidence.weakest[cell], support[cell], options);
  };
  std::vector<std::size_t> found;
  forEachFace(tiles, [&](const CellFace& face) {
    const float a = evidence.mean[face.first], b = evidence.mean[face.second];
    if ((a > 0) == (b > 0) || support[face.first] > 0 || support[face.second] > 0) return;
    if (matters(face.first, b)) found.push_back(face.first);
    if (matters(face.second, a)) found.push_back(face.second);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

CellEvidence carriedOver(const Octree& from, const CellEvidence& evidence, const Octree& to) {
  CellEvidence result(to.cellCount());
  std::size_t f = 0;
  for (std::size_t t = 0; t < to.cellCount(); ++t) {
    while (f < from.cellCount() && from.codes[f] < to.codes[t]) ++f;
    if (f == from.cellCount() || from.codes[f] != to.codes[t] || from.levels[f] != to.levels[t]) continue;
    result.mean[t] = evidence.mean[f], result.weakest[t] = evidence.weakest[f];
  }
  return result;
}

}  // namespace vdbfuse
