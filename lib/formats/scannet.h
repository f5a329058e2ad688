// SPDX-License-Identifier: Apache-2.0
// Scenes of ScanNet (Dai et al., CVPR 2017) as its exporter writes them, and folders of the same kind:
//
//   depth/N.png                     16 bit, millimetres, z, 0 invalid
//   pose/N.txt (poses/)             4×4 world_from_camera; frames whose pose is not finite are left out (a
//   note says
//                                   how many): the tracker had lost them
//   intrinsic/intrinsic_depth.txt   4×4 or 3×3 (or beside the folders; or any *intrinsic*.txt there)
//   color/N.jpg                     optional; with intrinsic/intrinsic_color.txt it has a camera of its own
//   at the
//                                   depth camera's pose, moved by extrinsic_color.txt (depth_from_color)
//                                   where it is given
#pragma once

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

DepthSetFormat scannetFormat();

}  // namespace vdbfuse
