// SPDX-License-Identifier: Apache-2.0
#include "formats/colmap_model_writer.h"

#include <algorithm>
#include <array>

#include "formats/colmap.h"
#include "formats/image_writer.h"
#include "formats/photo_writer.h"
#include "io/file_bytes.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

std::string camerasText(const std::vector<Pinhole>& cameras) {
  std::string text = "# CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Pinhole& c = cameras[i];
    text += std::to_string(i + 1) + " PINHOLE " + std::to_string(c.width) + " " + std::to_string(c.height) +
            numbersText({c.fx, c.fy, c.cx + 0.5, c.cy + 0.5}) + "\n";
  }
  return text;
}

// camera_from_world.
std::array<double, 7> poseNumbers(const ColmapView& view) {
  const RigidTransform pose = view.world_from_camera.inverse();
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  return {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()};
}

std::string imageText(std::size_t index, const ColmapView& view, std::size_t camera,
                      const std::string& points) {
  std::string text = std::to_string(index + 1);
  for (const double number : poseNumbers(view)) text += numbersText({number});
  return text + " " + std::to_string(camera + 1) + " " + view.file + "\n" + points + "\n";
}

// The cameras that differ, and which of them each view has.
struct CameraList {
  std::vector<Pinhole> cameras;
  std::vector<std::size_t> of_view;

  explicit CameraList(const std::vector<ColmapView>& views) {
    for (const ColmapView& view : views) {
      const auto found = std::find(cameras.begin(), cameras.end(), view.camera);
      of_view.push_back(static_cast<std::size_t>(found - cameras.begin()));
      if (found == cameras.end()) cameras.push_back(view.camera);
    }
  }
};

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

}  // namespace

void writeColmapText(const fs::path& folder, const std::vector<ColmapView>& views,
                     const std::vector<std::string>& seen, const std::string& points) {
  const CameraList list(views);
  std::string images =
      "# IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n# POINTS2D[] as (X, Y, POINT3D_ID)\n";
  for (std::size_t i = 0; i < views.size(); ++i) images += imageText(i, views[i], list.of_view[i], seen[i]);
  io::writeFileBytes(folder / "cameras.txt", camerasText(list.cameras));
  io::writeFileBytes(folder / "images.txt", images);
  io::writeFileBytes(folder / "points3D.txt", points);
}

void writeColmapBinary(const fs::path& folder, const std::vector<ColmapView>& views) {
  constexpr std::uint32_t kPinhole = 1;
  const CameraList list(views);
  std::string cameras, images;
  append<std::uint64_t>(cameras, list.cameras.size());
  for (std::size_t i = 0; i < list.cameras.size(); ++i) {
    const Pinhole& c = list.cameras[i];
    append(cameras, static_cast<std::uint32_t>(i + 1));
    append(cameras, kPinhole);
    for (const int side : {c.width, c.height}) append(cameras, static_cast<std::uint64_t>(side));
    for (const double value : {c.fx, c.fy, c.cx + 0.5, c.cy + 0.5}) append(cameras, value);
  }
  append<std::uint64_t>(images, views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    append(images, static_cast<std::uint32_t>(i + 1));
    for (const double value : poseNumbers(views[i])) append(images, value);
    append(images, static_cast<std::uint32_t>(list.of_view[i] + 1));
    images += views[i].file + '\0';
    append(images, std::uint64_t{0});
  }
  io::writeFileBytes(folder / "cameras.bin", cameras);
  io::writeFileBytes(folder / "images.bin", images);
  io::writeFileBytes(folder / "points3D.bin", std::string(sizeof(std::uint64_t), '\0'));
}

void writeColmapImages(const fs::path& folder, const PhotographSequence& photographs,
                       const ImageWriteOptions& options, const Progress& progress) {
  createFolder(folder / "sparse");
  const std::vector<std::string> names = writePictures(folder, "images", photographs, progress);
  std::vector<ColmapView> views;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PhotographHeader& header = photographs.header(i);
    views.push_back({names[i] + ".png", header.camera, header.world_from_camera});
  }
  if (options.encoding == ImageWriteOptions::Encoding::Binary) {
    writeColmapBinary(folder / "sparse", views);
  } else {
    writeColmapText(folder / "sparse", views, std::vector<std::string>(views.size()), kColmapPointTitle);
  }
}

}  // namespace vdbfuse
