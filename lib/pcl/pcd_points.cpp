// SPDX-License-Identifier: Apache-2.0
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <mutex>

#include "sensor/pcl_part.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// PCL prints what goes wrong; the library says it in its own words.
void silencePcl() {
  static std::once_flag once;
  std::call_once(once, [] { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); });
}

pcl::PointCloud<pcl::PointXYZ> readCloud(const std::filesystem::path& path) {
  pcl::PCLPointCloud2 stored;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  int result = -1;
  try {
    result = pcl::PCDReader().read(path.string(), stored, origin, orientation, version);
  } catch (const std::exception&) {  // result says it
  }
  if (result < 0) throw IoError(path, "", "the data that its header announces", "fewer or damaged data");
  pcl::PointCloud<pcl::PointXYZ> cloud;
  pcl::fromPCLPointCloud2(stored, cloud);
  return cloud;
}

}  // namespace
}  // namespace vdbfuse

extern "C" __attribute__((visibility("default"))) void vdbfuse_read_pcd_points(
    const std::filesystem::path& path, vdbfuse::PointImage& points) {
  vdbfuse::silencePcl();
  const pcl::PointCloud<pcl::PointXYZ> cloud = vdbfuse::readCloud(path);
  points = vdbfuse::noPoints(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  if (points.size() != cloud.size())
    throw vdbfuse::IoError(path, "", std::to_string(points.size()) + " points", std::to_string(cloud.size()));
  auto* target = points.data();
  for (const pcl::PointXYZ& p : cloud) *target++ = p.getVector3fMap();
}
