// SPDX-License-Identifier: Apache-2.0
#include "formats/kitti_sample.h"

#include <cstring>
#include <iomanip>
#include <sstream>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"

namespace vdbfuse::test {
namespace {

std::string line(const RigidTransform& transform) {
  std::ostringstream text;
  text << std::setprecision(12);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) text << transform.matrix()(row, column) << " ";
  }
  return text.str() + "\n";
}

// A scanner's x is our z, its y our -x, its z our -y.
std::string sweep(const View& view) {
  std::vector<float> values;
  for (int y = 0; y < view.map.depth.height(); ++y) {
    for (int x = 0; x < view.map.depth.width(); ++x) {
      if (view.map.depth(x, y) == kInvalidDepth) continue;
      const Eigen::Vector3f p = unproject(view.projection, x, y, view.map.depth(x, y)).cast<float>();
      values.insert(values.end(), {p.z(), -p.x(), -p.y(), 0.5F});
    }
  }
  return floatBytes(values);
}

RigidTransform worldFromLaser(const View& view) {
  RigidTransform pose = view.world_from_camera;
  const Eigen::Matrix3d camera = view.world_from_camera.linear();
  pose.linear() << camera.col(2), -camera.col(0), -camera.col(1);
  return pose;
}

void write(const std::filesystem::path& folder, const RigidTransform& camera_from_laser) {
  std::filesystem::create_directory(folder / "velodyne");
  std::string poses;
  for (const View& view : tinyDenseScans()) {
    writeText(folder / "velodyne" / ("00000" + view.name + ".bin"), sweep(view));
    poses += line(worldFromLaser(view) * camera_from_laser.inverse());
  }
  writeText(folder / "poses.txt", poses);
}

}  // namespace

std::string floatBytes(const std::vector<float>& values) {
  std::string bytes(4 * values.size(), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

void writeKittiOfCamera(const std::filesystem::path& folder) {
  RigidTransform camera_from_laser = RigidTransform::Identity();
  camera_from_laser.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera_from_laser.translation() << 0.1, -0.07, -0.27;
  write(folder, camera_from_laser);
  writeText(folder / "calib.txt", "P0: 700 0 600 0 0 700 180 0 0 0 1 0\nTr: " + line(camera_from_laser));
}

void writeKittiOfLaser(const std::filesystem::path& folder) { write(folder, RigidTransform::Identity()); }

}  // namespace vdbfuse::test
