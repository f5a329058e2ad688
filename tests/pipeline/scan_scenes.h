// SPDX-License-Identifier: Apache-2.0
// Small synthetic scans, and how to compare what was made of them.
#pragma once

#include <vector>

#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse::test {

inline std::vector<SyntheticView> smallScan(const Scene& scene, SynthOptions options, int width = 128) {
  options.width = width, options.height = 3 * width / 4;
  return renderAll(SyntheticScan(scene, options));
}

inline std::vector<View> viewsOf(const std::vector<SyntheticView>& scan) {
  std::vector<View> views;
  for (const SyntheticView& view : scan) views.push_back(view.view);
  return views;
}

inline double iouOf(const TriangleMesh& mesh, const TriangleMesh& truth) {
  EvaluateOptions options;
  options.samples = 2000, options.iou_resolution = 64;
  return evaluate(mesh, truth, options).iou.value_or(0);
}

}  // namespace vdbfuse::test
