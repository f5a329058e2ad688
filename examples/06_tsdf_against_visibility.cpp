// SPDX-License-Identifier: Apache-2.0
// The two methods on the same scan of a figure with thin legs and a deep cavity, every tenth depth wrong: one
// line of figures each, against the truth.
//   example_06_tsdf_against_visibility
#include <cstdio>
#include <exception>
#include <numeric>

#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;

double secondsOf(const Reconstruction& result) {
  return std::accumulate(result.steps.begin(), result.steps.end(), 0.0,
                         [](double sum, const StepTime& step) { return sum + step.seconds; });
}

Evaluation run(const char* name, Method method, const SyntheticScan& scan) {
  ReconstructOptions options;
  options.resolution = 96;
  options.method = method;
  const Reconstruction result = reconstruct(scan.views(), options);
  const Evaluation score = evaluate(result.mesh, scan.scene().truth);
  std::printf("%-12s %9zu %11zu %11zu %8.3f %8.3f %8.1f\n", name, result.mesh.triangles.size(),
              score.topology.components, score.topology.open_edges, score.iou.value_or(0),
              score.scores.front().fscore, secondsOf(result));
  return score;
}

}  // namespace

int main() try {
  SynthOptions scanner;
  scanner.views = 36;
  scanner.width = 240, scanner.height = 180;
  scanner.outliers = 0.1;
  const SyntheticScan scan(makeScene("figure"), scanner);

  std::printf("%-12s %9s %11s %11s %8s %8s %8s\n", "method", "triangles", "components", "open edges", "IoU",
              "F-score", "seconds");
  const Evaluation tsdf = run("tsdf", Method::Tsdf, scan);
  const Evaluation visibility = run("visibility", Method::Visibility, scan);
  const bool better = visibility.iou.value_or(0) > tsdf.iou.value_or(0);
  return better && visibility.topology.open_edges == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
