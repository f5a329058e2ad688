// SPDX-License-Identifier: Apache-2.0
// judgement.json, back in memory: everything of a judgement but its images.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {

struct ReadView {
  std::string name;
  int width = 0, height = 0;  ///< pixels
  double weight = 1;
};

struct ReadJudgement {
  SensorModel sensor;
  CalibrationReport calibration;
  ReliabilityModel model;
  Box domain;
  std::vector<ReadView> views;
};

/// Throws IoError, naming the member.
ReadJudgement readJudgementJson(const std::filesystem::path& path);

/// What judgement.json and judgement.txt say of a view.
struct ViewStatistics {
  double outlier_share = 0;       ///< mean ε of the measured pixels
  double no_returns_trusted = 0;  ///< share of the pixels without depth that mean empty space
  double outside_mask = 0;        ///< share of all pixels
};
ViewStatistics statistics(const JudgedView& view);

}  // namespace vdbfuse
