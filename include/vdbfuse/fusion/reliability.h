// SPDX-License-Identifier: Apache-2.0
// Which pixel to believe: the outlier probability of each pixel, inferred from the other views without a
// parameter (step 1 of the two: agreement, continuity and confidence).
#pragma once

#include <array>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/fusion/view_graph.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Learned probabilities of the two classes, by observation.
struct ReliabilityModel {
  static constexpr int kAgreements = 6;    ///< neighbour views that agree: 0 … 4, 5 or more
  static constexpr int kContinuities = 4;  ///< share of the 5×5 neighbourhood on the same surface
  static constexpr int kCells = kAgreements * kContinuities;
  static constexpr int kConfidences =
      20;  ///< quantile bins of the confidence; all in bin 0 when there is none

  double outlier_share = 0;
  /// Posterior probability of an outlier: [confidence bin][agreement · kContinuities + continuity].
  std::array<std::array<double, kCells>, kConfidences> outlier_given{};
  /// ε(c): outlier share of each confidence bin, lowest confidence first.
  std::array<double, kConfidences> outlier_by_confidence{};
  /// Upper ends of the confidence bins; empty when there is no confidence.
  std::vector<float> confidence_bins;
};

/// What the data say of their confidence.
enum class ConfidenceDirection { None, HighIsGood, HighIsBad, Uninformative };
ConfidenceDirection confidenceDirection(const ReliabilityModel& model);

struct Judgement {
  JudgedViews judged;
  ReliabilityModel model;
};

struct JudgeOptions {
  NeighbourOptions neighbours;
  enum class NoReturn { Ignore, Free, Auto } no_return = NoReturn::Auto;
};

/// Two-class EM over two observations that are independent given the class: the confidence (20 bins), and a
/// cell of agreement (neighbour views whose depth at the projected point is within 3 combined standard
/// deviations and whose normal is within 45°; a missing normal vetoes nothing) and continuity (4 bins).
/// Histograms, no parametric form; starts from "two or more agree and the surface continues". Without
/// confidence, agreement and continuity are taken as the two observations. Takes the views' images over.
Judgement judge(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                const JudgeOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
