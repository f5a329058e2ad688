// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/judge_scan.h"

#include "pipeline/steps.h"

namespace vdbfuse {

JudgedScan judgeScan(const ViewSequence& sequence, const ReconstructOptions& options,
                     const Progress& progress) {
  return judgeScan(sequence, options, planJudging(sequence, options), progress);
}

JudgedScan judgeScan(const ViewSequence& sequence, const ReconstructOptions& options, ScanPlan plan,
                     const Progress& progress) {
  requireUsable(sequence, options);
  JudgedScan scan;
  scan.plan = std::move(plan);
  scan.steps = scan.plan.steps;
  StepTimer timer;

  timer.start("load");
  std::vector<View> views = loadViews(sequence, scan, progress);

  timer.start("calibrate");
  const DepthStatistics depths = depthStatistics(views, options.domain);
  const ViewGraph graph = makeGraph(views, depths);
  const SensorModel sensor = calibrateSensor(views, graph, depths, options, scan.calibration, progress);

  timer.start("judge");
  scan.judgement =
      judgeViews(std::move(views), sensor, graph, options, scan.calibration, progress);  // ε, w, domain
  for (StepTime& timed : timer.finish()) scan.steps.push_back(std::move(timed));
  return scan;
}

}  // namespace vdbfuse
