// SPDX-License-Identifier: Apache-2.0
#include "formats/camera_samples.h"

#include <cmath>
#include <sstream>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::test {
namespace {

namespace fs = std::filesystem;

const Pinhole& cameraOf(const View& view) { return std::get<Pinhole>(view.projection); }

// x right, y up, z backward.
Eigen::Matrix4d openGlPose(const View& view) {
  return view.world_from_camera.matrix() * Eigen::Vector4d(1, -1, -1, 1).asDiagonal();
}

std::string json(const std::string& key, const std::string& value) { return "\"" + key + "\": " + value; }

std::string text(double value) {
  std::ostringstream stream;
  stream.precision(17);
  stream << value;
  return stream.str();
}

}  // namespace

std::string rows(const Eigen::MatrixXd& matrix, const std::string& separator, const std::string& line_end) {
  std::string result;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) result += (c > 0 ? separator : "") + text(matrix(r, c));
    if (r + 1 < matrix.rows() || line_end == "\n") result += line_end;
  }
  return result;
}

void writeDepthInSteps(const fs::path& path, const Image<float>& depth, double step) {
  Image<std::uint16_t> stored(depth.width(), depth.height());
  for (std::size_t i = 0; i < depth.size(); ++i)
    stored.data()[i] = static_cast<std::uint16_t>(std::lround(depth.data()[i] / step));
  writePng(path, stored);
}

void writeIclNuim(const fs::path& folder) {
  fs::create_directories(folder / "depth");
  fs::create_directories(folder / "rgb");
  std::string associations, poses;
  const Eigen::Vector3d flip(1, -1, 1);
  for (const View& view : tinyViews()) {
    writeDepthInSteps(folder / "depth" / (view.name + ".png"), view.map.depth, 0.0002);
    writePng(folder / "rgb" / (view.name + ".png"), view.map.color);
    associations += view.name + " depth/" + view.name + ".png " + view.name + " rgb/" + view.name + ".png\n";
    const Eigen::Quaterniond q(
        Eigen::Matrix3d(flip.asDiagonal() * view.world_from_camera.linear() * flip.asDiagonal()));
    const Eigen::Vector3d t = flip.asDiagonal() * view.world_from_camera.translation();
    poses += view.name + " " + rows(t.transpose(), " ", "\n");
    poses.back() = ' ';
    poses += rows(q.coeffs().transpose(), " ", "\n");
  }
  writeText(folder / "associations.txt", associations);
  writeText(folder / "livingRoom.gt.freiburg", poses);
  writeText(folder / "intrinsics.txt", "22.5 -23.25 11.75 8.5\n");
}

void writeScannet(const fs::path& folder) {
  for (const char* name : {"depth", "color", "pose", "intrinsic"}) fs::create_directories(folder / name);
  for (const View& view : tinyViews()) {
    writeDepthInSteps(folder / "depth" / (view.name + ".png"), view.map.depth, 0.001);
    writePng(folder / "color" / (view.name + ".png"), view.map.color);
    writeText(folder / "pose" / (view.name + ".txt"), rows(view.world_from_camera.matrix(), " ", "\n"));
  }
  const std::string camera = "22.5 0 11.75 0\n0 23.25 8.5 0\n0 0 1 0\n0 0 0 1\n";
  writeText(folder / "intrinsic" / "intrinsic_depth.txt", camera);
  writeText(folder / "intrinsic" / "intrinsic_color.txt", camera);
  writeText(folder / "intrinsic" / "extrinsic_color.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
}

void writePolycam(const fs::path& folder) {
  const fs::path root = folder / "keyframes";
  for (const char* name : {"corrected_cameras", "depth", "confidence"}) fs::create_directories(root / name);
  for (const View& view : tinyViews()) {
    writeDepthInSteps(root / "depth" / (view.name + ".png"), view.map.depth, 0.001);
    writePng(root / "confidence" / (view.name + ".png"), Image<std::uint8_t>(24, 18, std::uint8_t{255}));
    const Eigen::Matrix4d pose = openGlPose(view);
    const Pinhole& c = cameraOf(view);
    std::string camera = "{";
    for (int i = 0; i < 12; ++i)
      camera += json("t_" + std::to_string(i / 4) + std::to_string(i % 4), text(pose(i / 4, i % 4))) + ", ";
    // The picture is four times as large.
    camera += json("fx", text(4 * c.fx)) + ", " + json("fy", text(4 * c.fy)) + ", ";
    camera += json("cx", text(4 * (c.cx + 0.5) - 0.5)) + ", " + json("cy", text(4 * (c.cy + 0.5) - 0.5));
    writeText(root / "corrected_cameras" / (view.name + ".json"),
              camera + ", \"width\": 96, \"height\": 72, \"blur_score\": 80.1}");
  }
}

void writeScannerApp(const fs::path& folder) {
  for (const View& view : tinyViews()) {
    const std::string name = "0000" + view.name;
    writeDepthInSteps(folder / ("depth_" + name + ".png"), view.map.depth, 0.001);
    writePng(folder / ("conf_" + name + ".png"), Image<std::uint8_t>(24, 18, std::uint8_t{2}));
    const Pinhole& c = cameraOf(view);
    writeText(folder / ("frame_" + name + ".json"),
              "{" + json("cameraPoseARFrame", "[" + rows(openGlPose(view), ", ", ", ") + "]") + ", " +
                  json("intrinsics", "[" + text(c.fx) + ", 0, " + text(c.cx) + ", 0, " + text(c.fy) + ", " +
                                         text(c.cy) + ", 0, 0, 1]") +
                  "}");
  }
  writePng(folder / "frame_00000.png", Image<Rgb8>(24, 18, Rgb8{9, 8, 7}));
}

}  // namespace vdbfuse::test
