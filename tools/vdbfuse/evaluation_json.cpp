// SPDX-License-Identifier: Apache-2.0
#include "evaluation_json.h"

#include <cmath>

namespace vdbfuse::tool {

Json finiteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json orNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::vector<double> tausOf(const Evaluation& evaluation) {
  std::vector<double> taus;
  for (const ScoreAtTau& score : evaluation.scores) taus.push_back(score.tau);
  return taus;
}

Json evaluationJson(const Evaluation& e) {
  Json precision, recall, fscore, regions = Json::object();
  for (const ScoreAtTau& score : e.scores) {
    precision.push_back(score.precision);
    recall.push_back(score.recall);
    fscore.push_back(score.fscore);
  }
  for (const RegionShare& region : e.regions) regions[region.name] = orNull(region.share);
  return {{"accuracy90", finiteOrNull(e.accuracy90)},
          {"accuracy_rms", finiteOrNull(e.accuracy_rms)},
          {"completeness", e.completeness},
          {"tau", tausOf(e)},
          {"precision", precision},
          {"recall", recall},
          {"fscore", fscore},
          {"iou", orNull(e.iou)},
          {"vertices", e.topology.used_vertices},
          {"triangles", e.topology.triangles},
          {"components", e.topology.components},
          {"open_edges", e.topology.open_edges},
          {"nonmanifold_edges", e.topology.nonmanifold_edges},
          {"nonmanifold_vertices", e.topology.nonmanifold_vertices},
          {"inconsistent_edges", e.topology.inconsistent_edges},
          {"euler_number", e.topology.euler_number},
          {"closed", isClosedManifold(e.topology)},
          {"regions", regions}};
}

}  // namespace vdbfuse::tool
