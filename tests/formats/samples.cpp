// SPDX-License-Identifier: Apache-2.0
#include "formats/samples.h"

#include <fstream>

#include "formats/camera_samples.h"
#include "formats/colmap_sample.h"
#include "formats/e57_writer.h"
#include "formats/kitti_sample.h"
#include "formats/numpy_sample.h"
#include "formats/points_sample.h"
#include "formats/ptx_sample.h"
#include "formats/sens_sample.h"
#include "formats/stanford_sample.h"
#include "formats/tiny_scene.h"
#include "formats/transforms_sample.h"
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

// Two cameras, so that the trajectory is JSON.
void writeOpen3dJson(const std::filesystem::path& folder) {
  std::vector<View> views = tinyViews();
  std::get<Pinhole>(views[1].projection).cx += 1e-9;
  writeDepthSet(folder, "open3d", ViewSequence::fromViews(views));
}

constexpr char kNumpy[] = "numpy", kTransforms[] = "transforms", kColmap[] = "colmap", kOpen3d[] = "open3d";
constexpr char kRgbd[] = "rgbd", kMvsnet[] = "mvsnet", kTum[] = "tum";
void writePtxFile(const std::filesystem::path& folder) {
  std::ofstream(folder / "scans.ptx") << ptxOfTwoScans();
}

template <E57Part (*make)(const View&)>
void writeE57(const std::filesystem::path& folder) {
  std::vector<E57Part> parts;
  for (const View& view : make == loosePart ? tinyDenseScans() : tinySphericalViews())
    parts.push_back(make(view));
  std::ofstream(folder / "scans.e57", std::ios::binary) << e57File(parts);
}

template <int color, int depth>
void writeSens(const std::filesystem::path& folder) {
  std::ofstream(folder / "a.sens", std::ios::binary) << sensBytes(tinyRecording(color, depth));
}

constexpr char kPtx[] = "ptx";

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
      {"numpy", "written", writeAs<kNumpy>, ""},
      {"numpy", "vggt", writeVggtSample, "predictions.npz"},
      {"numpy", "cut3r", writeCut3rSample, ""},
      {"numpy", "frame_files", writeFrameFilesSample, ""},
      {"numpy", "array_files", writeArrayFilesSample, ""},
      {"transforms", "written", writeAs<kTransforms>, ""},
      {"transforms", "instant_ngp", writeInstantNgpSample, ""},
      {"transforms", "nerfstudio", writeNerfstudioSample, "transforms.json"},
      {"colmap", "written", writeAs<kColmap>, ""},
      {"colmap", "text", writeColmapTextSample, ""},
      {"colmap", "rig", writeColmapRigSample, ""},
      {"open3d", "log", writeAs<kOpen3d>, ""},
      {"open3d", "json", writeOpen3dJson, ""},
      {"ptx", "written", writeAs<kPtx>, ""},
      {"ptx", "two_scans", writePtxFile, "scans.ptx"},
      {"e57", "cartesian_floats", writeE57<cartesianPart>, "scans.e57"},
      {"e57", "spherical_integers", writeE57<sphericalPart>, "scans.e57"},
      {"e57", "loose_doubles", writeE57<loosePart>, "scans.e57"},
      {"sens", "jpeg_zlib", writeSens<2, 1>, "a.sens"},
      {"sens", "png_raw", writeSens<1, 0>, "a.sens"},
      {"kitti", "poses_of_camera", writeKittiOfCamera, ""},
      {"kitti", "poses_of_laser", writeKittiOfLaser, ""},
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
