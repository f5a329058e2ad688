// SPDX-License-Identifier: Apache-2.0
// How well a few views agree with each other under one reading of their poses and depths.
#pragma once

#include <vector>

#include "vdbfuse/fusion/conventions.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// world_from_camera under another reading of the pose on disk.
RigidTransform poseUnder(const RigidTransform& world_from_camera, const RigidTransform& stored_from_camera,
                         const Convention& convention);

/// What a depth in the sensor's own measure becomes under another reading.
class DepthReader {
 public:
  DepthReader(const Projection& projection, const Convention& convention)
      : pinhole_(convention.depth == Convention::Depth::Range ? std::get_if<Pinhole>(&projection) : nullptr),
        factor_(convention.depth_factor) {}
  double operator()(int x, int y, double depth) const {
    if (pinhole_ == nullptr) return factor_ * depth;
    return factor_ * depth / unproject(*pinhole_, x, y, 1.0).norm();
  }

 private:
  const Pinhole* pinhole_;
  double factor_;
};

struct SampledPixel {
  int x = 0, y = 0;
  double depth = 0;
};

struct SampledView {
  View view;
  RigidTransform stored_from_camera = RigidTransform::Identity();
  std::vector<SampledPixel> pixels;
};

/// Views and pixels evenly spread over what there is; views without a valid pixel are left out.
std::vector<SampledView> sampleViews(const ViewSequence& views,
                                     const std::vector<RigidTransform>& stored_from_camera,
                                     const ConventionOptions& options);

/// Median over the views of the diagonal of the box of their points, tails left out. REQUIRES: there are
/// views.
double typicalSize(const std::vector<SampledView>& views);

/// The share of RatedConvention::agreement. `tolerance` is a length for depths as they were read.
double agreementUnder(const std::vector<SampledView>& views, const Convention& convention, double tolerance);

}  // namespace vdbfuse
