// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/judge_scan.h"

#include "pipeline/steps.h"

namespace vdbfuse {

JudgedScan judgeScan(const ViewSequence& sequence, const ReconstructOptions& options,
                     const Progress& progress) {
  requireUsable(sequence, options);
  JudgedScan scan;
  StepTimer timer;

  timer.start("load");
  std::vector<View> views = loadViews(sequence, progress);
  scan.width = static_cast<std::size_t>(views.front().map.depth.width());
  scan.height = static_cast<std::size_t>(views.front().map.depth.height());

  timer.start("calibrate");
  const DepthStatistics depths = depthStatistics(views, options.domain);
  const ViewGraph graph = makeGraph(views, depths);
  const SensorModel sensor = calibrateSensor(views, graph, depths, options, scan.calibration, progress);

  timer.start("judge");
  scan.judgement =
      judgeViews(std::move(views), sensor, graph, options, scan.calibration, progress);  // ε, w, domain
  scan.steps = timer.finish();
  return scan;
}

}  // namespace vdbfuse
