// SPDX-License-Identifier: Apache-2.0
// Sequences of the TUM RGB-D benchmark (Sturm et al., IROS 2012), and of ICL-NUIM (Handa et al., ICRA 2014)
// in the same layout:
//
//   depth.txt            "time depth/NAME.png" a line; or associations.txt (associate.txt), where it stands
//   beside
//                        the picture, in either order
//   rgb.txt              optional, "time rgb/NAME.png"
//   groundtruth.txt      "time tx ty tz qx qy qz qw", world_from_camera; or the one *.freiburg (ICL-NUIM)
//   *intrinsics*.txt     optional: fx fy cx cy, or a 3×3 matrix
//   depth/NAME.png       16 bit, steps of 1/5000 m, z, 0 invalid
//
// Where the data set has no intrinsics, they are those that its authors recommend (a note says so): 525, 525,
// 319.5, 239.5 for TUM, 481.2, −480, 319.5, 239.5 for ICL-NUIM. A negative fy belongs to a left-handed
// camera: both it and the world are turned into right-handed ones by changing the sign of y (a note says so).
#pragma once

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

DepthSetFormat tumFormat();

}  // namespace vdbfuse
