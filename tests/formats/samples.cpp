// SPDX-License-Identifier: Apache-2.0
#include "formats/samples.h"

#include <fstream>

#include "formats/camera_samples.h"
#include "formats/points_sample.h"
#include "formats/stanford_sample.h"
#include "formats/tiny_scene.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse::test {
namespace {

template <const char* format>
void writeAs(const std::filesystem::path& folder) {
  writeDepthSet(folder, format, ViewSequence::fromViews(tinyViews()));
}

#ifdef VDBFUSE_TEST_PCL
void writePcd(const std::filesystem::path& folder) {
  for (const View& view : tinyViews()) {
    std::ofstream file(folder / (view.name + ".pcd"));
    const Eigen::Quaterniond turn(view.world_from_camera.linear());
    file.precision(17);
    file << "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 24\nHEIGHT 18\nVIEWPOINT "
         << view.world_from_camera.translation().transpose() << " " << turn.w() << " "
         << turn.vec().transpose() << "\nPOINTS 432\nDATA ascii\n";
    for (const Eigen::Vector3f& p : pointsOf(view)) file << p.transpose() << "\n";
  }
}
#endif

constexpr char kRgbd[] = "rgbd", kMvsnet[] = "mvsnet", kTum[] = "tum";

}  // namespace

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all = {
      {"rgbd", "written", writeAs<kRgbd>, ""},
      {"tum", "written", writeAs<kTum>, ""},
      {"tum", "icl_nuim", writeIclNuim, ""},
      {"scannet", "exported", writeScannet, ""},
      {"arkit", "polycam", writePolycam, ""},
      {"arkit", "scanner_app", writeScannerApp, ""},
      {"mvsnet", "written", writeAs<kMvsnet>, ""},
#ifdef VDBFUSE_TEST_PCL
      {"pcd", "ascii", writePcd, ""},
#endif
      {"stanford", "ascii", writeStanfordAscii, ""},
      {"stanford", "binary", writeStanfordBinary, "scans.conf"},
      {"stanford", "pinhole", writeStanfordPinhole, ""},
      {"points", "xyz_poses", writeXyzWithPoses, ""},
      {"points", "pcd_trajectory", writePcdWithTrajectory, ""},
      {"points", "ply_numbered_poses", writePlyWithNumberedPoses, ""},
      {"points", "ply_sensors", writePlyWithSensors, "points.ply"},
      {"points", "xyz_sensors", writeXyzWithSensors, "points.xyz"},
      {"points", "pcd_sensors", writePcdWithSensors, "points.pcd"},
  };
  return all;
}

}  // namespace vdbfuse::test
