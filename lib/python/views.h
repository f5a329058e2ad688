// SPDX-License-Identifier: Apache-2.0
// Views made of arrays.
#pragma once

#include <string>

#include "python/arrays.h"
#include "python/read_options.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse::python {

/// What the poses of arrays mean.
struct PoseReading {
  bool is_camera_from_world = false;
  bool has_opengl_axes = false;  ///< x right, y up, z backward
};

/// The frame that such poses speak of, from the camera's.
RigidTransform storedFromCamera(const PoseReading& reading);

/// world_from_camera of a 4×4 matrix. Throws InvalidArgument that begins with `where`.
RigidTransform poseOf(const std::string& where, const py::array_t<double>& matrix,
                      const PoseReading& reading);

/// fx, fy, cx, cy, k1, k2, p1, p2, k3.
Pinhole pinholeOf(const py::array_t<double>& numbers, int width, int height);

/// The images of one view, checked in Python: depth (H, W) float32 or uint16; None or confidence (H, W)
/// float32, color (H', W', 3) uint8, mask (H, W) uint8.
struct ViewArrays {
  py::array depth;
  py::object confidence, color, mask;
};
/// Of a tuple in that order.
ViewArrays viewArrays(const py::tuple& arrays);

/// Copies of the images, the depths in the sensor's own measure. Lets go of the interpreter's lock meanwhile.
/// Throws InvalidArgument.
DepthMap depthMap(const ViewArrays& arrays, const Projection& projection, const ReadOptions& options);

}  // namespace vdbfuse::python
