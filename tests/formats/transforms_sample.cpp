// SPDX-License-Identifier: Apache-2.0
#include "formats/transforms_sample.h"

#include <cmath>
#include <sstream>

#include "formats/numpy_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::test {
namespace {

// In camera axes x right, y up, z backward.
std::string poseText(const View& view) {
  const Eigen::Matrix4d m = view.world_from_camera.matrix();
  std::ostringstream text;
  text.precision(17);
  for (int row = 0; row < 4; ++row)
    text << (row ? ", [" : "[[") << m(row, 0) << ", " << -m(row, 1) << ", " << -m(row, 2) << ", " << m(row, 3)
         << "]";
  return text.str() + "]";
}

}  // namespace

void writeInstantNgpSample(const std::filesystem::path& folder) {
  std::string frames;
  for (const View& view : tinyViews()) {
    Image<std::uint16_t> depth(24, 18);
    for (std::size_t i = 0; i < depth.size(); ++i)
      depth.data()[i] = static_cast<std::uint16_t>(std::lround(view.map.depth.data()[i] / 0.0005));
    writePng(folder / (view.name + ".png"), depth);
    frames += (frames.empty() ? "" : ",\n") + std::string("{\"depth_path\": \"./") + view.name +
              ".png\", \"transform_matrix\": " + poseText(view) + "}";
  }
  std::ostringstream text;
  text.precision(17);
  text << "{\"camera_angle_x\": " << 2 * std::atan(12 / 22.5)
       << ", \"camera_angle_y\": " << 2 * std::atan(9 / 23.25)
       << ", \"cx\": 12.25, \"cy\": 9.0, \"integer_depth_scale\": 0.0005,\n"
       << "\"enable_depth_loading\": true, \"frames\": [" << frames << "]}";
  writeText(folder / "transforms.json", text.str());
}

void writeNerfstudioSample(const std::filesystem::path& folder) {
  for (const char* name : {"images", "depths"}) std::filesystem::create_directory(folder / name);
  std::string frames;
  for (const View& view : tinyViews()) {
    writeText(folder / "depths" / (view.name + ".npy"),
              npyText("<f4", "(18, 24)", bytesOf<float>(view.map.depth)));
    writePng(folder / "images" / (view.name + ".png"), Image<Rgb8>(48, 36, Rgb8{1, 2, 3}));
    frames += (frames.empty() ? "" : ",\n") + std::string("{\"file_path\": \"images/") + view.name +
              ".png\", \"depth_file_path\": \"depths/" + view.name +
              ".npy\", \"fl_x\": 45, \"fl_y\": 46.5, \"cx\": 24.5, \"cy\": 18.0, \"w\": 48, \"h\": 36, "
              "\"transform_matrix\": " +
              poseText(view) + "}";
  }
  writeText(folder / "transforms.json", "{\"camera_model\": \"OPENCV\", \"frames\": [" + frames + "]}");
}

}  // namespace vdbfuse::test
