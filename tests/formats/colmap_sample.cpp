// SPDX-License-Identifier: Apache-2.0
#include "formats/colmap_sample.h"

#include <sstream>

#include "formats/numpy_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"

namespace vdbfuse::test {
namespace {

template <class T>
std::string raw(T value) {
  return bytesOf<T>(std::vector<T>{value});
}

std::vector<double> poseNumbers(const RigidTransform& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()};
}

std::string rawPose(const RigidTransform& pose) { return bytesOf<double>(poseNumbers(pose)); }

void writeDepth(const std::filesystem::path& folder, const std::string& name, const View& view) {
  const std::filesystem::path path = folder / "stereo/depth_maps" / name;
  std::filesystem::create_directories(path.parent_path());
  writeText(path, colmapMap(view.map.depth));
}

// Of camera 1: OPENCV without distortion; of camera 2: PINHOLE.
std::string rawCameras() {
  const std::vector<double> lens = {22.5, 23.25, 12.25, 9.0};
  return raw<std::uint64_t>(2) + raw<std::uint32_t>(1) + raw<std::int32_t>(4) + raw<std::uint64_t>(24) +
         raw<std::uint64_t>(18) + bytesOf<double>(lens) + std::string(32, '\0') + raw<std::uint32_t>(2) +
         raw<std::int32_t>(1) + raw<std::uint64_t>(24) + raw<std::uint64_t>(18) + bytesOf<double>(lens);
}

}  // namespace

std::string colmapPose(const RigidTransform& pose) {
  std::ostringstream text;
  text.precision(17);
  for (const double number : poseNumbers(pose)) text << " " << number;
  return text.str().substr(1);
}

std::string colmapMap(const Image<float>& depth) {
  return std::to_string(depth.width()) + "&" + std::to_string(depth.height()) + "&1&" + bytesOf<float>(depth);
}

void writeColmapTextSample(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "sparse/0");
  std::string images = "# Image list\n";
  for (const View& view : tinyViews()) {
    images += view.name + " " + colmapPose(view.world_from_camera.inverse()) + " 7 " + view.name +
              ".jpg\n1.5 2.5 -1\n";
    writeDepth(folder, view.name + ".jpg.geometric.bin", view);
  }
  writeText(folder / "sparse/0/cameras.txt", "# Camera list\n7 PINHOLE 48 36 45 46.5 24.5 18\n");
  writeText(folder / "sparse/0/images.txt", images);
}

void writeColmapRigSample(const std::filesystem::path& folder) {
  const std::vector<View> views = tinyViews(3);
  std::filesystem::create_directories(folder / "sparse");
  // Camera 1 takes views 0 and 2; camera 2, which stands beside it, view 1.
  const RigidTransform second_from_rig(Eigen::Translation3d(-0.5, 0, 0.25) *
                                       Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
  std::string images = raw<std::uint64_t>(3), frames = raw<std::uint64_t>(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t camera = i == 1 ? 2 : 1;
    const std::string name = "cam" + std::to_string(camera) + "/" + views[i].name + ".png";
    const RigidTransform camera_from_world = views[i].world_from_camera.inverse();
    images += raw(10 + i) + rawPose(camera_from_world) + raw(camera) + name + std::string(1, '\0') +
              raw<std::uint64_t>(i) + std::string(24 * i, 'x');
    frames += raw(20 + i) + raw<std::uint32_t>(5) +
              rawPose(camera == 2 ? second_from_rig.inverse() * camera_from_world : camera_from_world) +
              raw<std::uint32_t>(1) + raw<std::int32_t>(0) + raw(camera) + raw<std::uint64_t>(10 + i);
    writeDepth(folder, name + (i == 2 ? ".photometric.bin" : ".geometric.bin"), views[i]);
  }
  writeText(folder / "sparse/cameras.bin", rawCameras());
  writeText(folder / "sparse/images.bin", images);
  writeText(folder / "sparse/frames.bin", frames);
  writeText(folder / "sparse/rigs.bin", raw<std::uint64_t>(1) + raw<std::uint32_t>(5) +
                                            raw<std::uint32_t>(2) + raw<std::int32_t>(0) +
                                            raw<std::uint32_t>(1) + raw<std::int32_t>(0) +
                                            raw<std::uint32_t>(2) + "\1" + rawPose(second_from_rig));
}

}  // namespace vdbfuse::test
