// SPDX-License-Identifier: Apache-2.0
// Which pixel to believe: the outlier probability of each pixel, inferred from the other views without a
// parameter.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/fusion/view_graph.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// What the data say of their confidence.
enum class ConfidenceDirection { None, HighIsGood, HighIsBad, Uninformative };

/// What was learned of a data set's pixels.
struct ReliabilityModel {
  static constexpr std::size_t kConfidences = 20;  ///< quantile bins of the confidence
  double outlier_share = 0;
  /// Upper ends of the confidence bins, the last one left out; empty when there is no confidence.
  std::vector<float> confidence_bins;
  /// ε(c): outlier share of each confidence bin, lowest confidence first; all equal without confidence.
  std::array<double, kConfidences> outlier_by_confidence{};
};

ConfidenceDirection confidenceDirection(const ReliabilityModel& model);

struct Judgement {
  JudgedViews judged;
  ReliabilityModel model;
  Box domain;  ///< the one given, or supportedDomain() of the first pass
};

struct JudgeOptions {
  NeighbourOptions neighbours;
  /// What a missing depth around an object means. Auto: free space when it fills most of most images'
  /// borders.
  enum class NoReturn { Ignore, Free, Auto } no_return = NoReturn::Auto;
  /// The second pass, leave-one-out denial; costs about as much as the first.
  enum class Denial { Skip, Examine } denial = Denial::Examine;
  /// World box of the reconstruction; default: found after the first pass.
  std::optional<Box> domain;
};

/// Two-class EM (inlier, outlier) over observations that are independent given the class, histograms, no
/// parametric form: the confidence (20 quantile bins), and a cell of *agreement* (neighbour views that
/// measured the same point, with normals within 45°), *contradiction* (neighbours that see past it) and
/// *continuity* (share of the 5×5 neighbourhood on the same surface). Without confidence, or where it turns
/// out to say nothing, continuity is an observation of its own.
/// Then one step of Bayes' rule, outside the EM, with *denial*: the smallest evidence of all other views
/// where the pixel claims free space. Alternative depths are judged as if they were views of their own,
/// without denial, and compete; the likeliest becomes the depth. Starts from: two or more agree and the
/// surface continues = inlier; contradicted by more than agree = outlier; nobody speaks for or against =
/// undecided, because only evidence against condemns. Takes the views' images over. `sensor`: its noise and
/// range. Throws InvalidArgument when nothing is supported.
Judgement judge(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                const JudgeOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
