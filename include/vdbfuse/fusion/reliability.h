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
  /// borders and no other view measured anything there; a view that misses a fifth of what it might have met
  /// is not believed at all.
  enum class NoReturn { Ignore, Free, Auto } no_return = NoReturn::Auto;
  /// The second pass, leave-one-out denial; a third of the time, and most of it with many small views.
  enum class Denial { Skip, Examine } denial = Denial::Examine;
  /// World box of the reconstruction; default: found after the first pass.
  std::optional<Box> domain;
};

/// Odds of an outlier are a product of what is observed and independent given the class:
///  - the share of outliers among the pixels of the same *continuity* (share of the 5×5 neighbourhood on the
///    same surface), learned by EM;
///  - what the neighbour views answer: *agreement* (they measured the same point, with normals within 45°),
///    *contradiction* (they see past it), and, where there is neither, *occlusion* although the surface faces
///    them and *misses*; as likelihood ratios known beforehand to an order of magnitude, of which those of
///    occlusion and misses are lowered where, after the EM, most such pixels are right;
///  - the *confidence*, in 20 quantile bins, whose ratios are learned by the same EM: any scale, either
///    direction, no harm where it says nothing;
///  - *denial*, the smallest evidence of all other views where the pixel claims free space, by one step of
///    Bayes' rule after the EM.
/// Only evidence against condemns: a pixel of which nobody says anything gets the share of its kind.
/// Alternative depths are judged as if they were views of their own, without denial, and compete; the
/// likeliest becomes the depth. Takes the views' images over. `sensor`: its noise and range. Throws
/// InvalidArgument when nothing is supported.
Judgement judge(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                const JudgeOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
