// SPDX-License-Identifier: Apache-2.0
#include "formats/ptx_sample.h"

#include <iomanip>
#include <sstream>

#include "formats/tiny_scene.h"

namespace vdbfuse::test {

std::string ptxScan(const View& view, bool color) {
  std::ostringstream text;
  text << std::setprecision(12);
  const int columns = view.map.depth.width(), rows = view.map.depth.height();
  text << columns << "\n" << rows << "\n";
  // A scanner's x is our z, its y our -x, its z our -y.
  const Eigen::Matrix3d r = view.world_from_camera.linear();
  const Eigen::Vector3d axes[3] = {r.col(2), -r.col(0), -r.col(1)}, t = view.world_from_camera.translation();
  text << t.transpose() << "\n";
  for (const Eigen::Vector3d& axis : axes) text << axis.transpose() << "\n";
  for (const Eigen::Vector3d& axis : axes) text << axis.transpose() << " 0\n";
  text << t.transpose() << " 1\n";
  for (int x = 0; x < columns; ++x) {
    for (int y = rows - 1; y >= 0; --y) {
      const float depth = view.map.depth(x, y);
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      if (depth > 0) p = unproject(view.projection, x, y, depth);
      text << p.z() << " " << 0 - p.x() << " " << 0 - p.y() << " 0.5" << (color ? " 10 20 30" : "") << "\n";
    }
  }
  return text.str();
}

std::string ptxOfTwoScans() {
  const std::vector<View> views = tinySphericalViews();
  return ptxScan(views[0], true) + ptxScan(views[1], true);
}

}  // namespace vdbfuse::test
