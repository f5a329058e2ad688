// SPDX-License-Identifier: Apache-2.0
// Captures of phones with a laser (ARKit). Camera axes are ARKit's: x right, y up, z backward; poses
// world_from_camera with y up. Intrinsics are those of the picture; depth maps are smaller and the camera is
// brought to their size. Two layouts:
//
//   Polycam (raw data)                       3D Scanner App (all data)
//   keyframes/corrected_cameras/NAME.json    frame_N.json    "cameraPoseARFrame" 16 numbers, "intrinsics" 9,
//     (else keyframes/cameras)                               both row by row
//     t_00 … t_23, fx fy cx cy width height
//   keyframes/depth/NAME.png                 depth_N.png     16 bit, millimetres, z, 0 invalid
//   keyframes/confidence/NAME.png            conf_N.png      optional, higher is better
//   keyframes/images/NAME.jpg                frame_N.jpg     at least one, which gives the pictures' size
//     (corrected_images for corrected cameras)
#pragma once

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

DepthSetFormat arkitFormat();

}  // namespace vdbfuse
