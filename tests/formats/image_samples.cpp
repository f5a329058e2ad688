// SPDX-License-Identifier: Apache-2.0
#include "formats/image_samples.h"

#include <sstream>

#include "formats/colmap_sample.h"
#include "formats/numpy_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/formats/image_set.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::test {
namespace {

namespace fs = std::filesystem;

template <const char* format>
void writeAs(const fs::path& folder) {
  writeImageSet(folder, format, PhotographSequence::fromPhotographs(tinyPhotographs()));
}

void writeBinaryColmap(const fs::path& folder) {
  writeImageSet(folder, "colmap", PhotographSequence::fromPhotographs(tinyPhotographs()),
                {ImageWriteOptions::Encoding::Binary});
}

// The workspace with depth maps is one of photographs too, once it has pictures.
void writeColmapRig(const fs::path& folder) {
  writeColmapRigSample(folder);
  for (const char* name : {"cam1/0.png", "cam2/1.png", "cam1/2.png"}) {
    fs::create_directories((folder / "images" / name).parent_path());
    writePng(folder / "images" / name, Image<Rgb8>(24, 18, Rgb8{1, 2, 3}));
  }
}

void writePhotographs(const fs::path& folder) {
  fs::create_directories(folder);
  for (const Photograph& photograph : tinyPhotographs()) {
    if (photograph.color.empty())
      writePng(folder / (photograph.name + ".png"), Image<std::uint8_t>(24, 18, std::uint8_t{9}));
    else
      writePng(folder / (photograph.name + ".png"), photograph.color);
  }
}

std::ostringstream preciseText() {
  std::ostringstream text;
  text.precision(17);
  return text;
}

template <class T>
std::string raw(T value) {
  return bytesOf<T>(std::vector<T>{value});
}

constexpr char kMiddlebury[] = "middlebury", kMvsnet[] = "mvsnet", kTransforms[] = "transforms";
constexpr char kColmap[] = "colmap", kStrecha[] = "strecha", kBundler[] = "bundler", kNvm[] = "nvm";

}  // namespace

std::vector<Photograph> tinyPhotographs() {
  std::vector<Photograph> photographs;
  for (View& view : tinyViews(4)) {
    Photograph photograph;
    photograph.name = view.name;
    photograph.camera = {24, 18, 22.5, 22.5, 11.5, 8.5, {}};
    photograph.world_from_camera = view.world_from_camera;
    photograph.depth = DepthInterval{1.4, 3};
    photograph.color = std::move(view.map.color);
    photograph.brightness = brightnessOf(photograph.color);
    photographs.push_back(std::move(photograph));
  }
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x)
      photographs[2].brightness(x, y) = static_cast<float>((2001 * x + 517 * y) / 65535.0);
  photographs[2].color = {};
  photographs[1].mask = Image<std::uint8_t>(24, 18, std::uint8_t{255});
  photographs[1].mask(5, 7) = 0;
  return photographs;
}

std::vector<Eigen::Vector3d> tinyPoints() {
  std::vector<Eigen::Vector3d> points;
  for (int i = -3; i <= 3; ++i)
    for (int k = -2; k <= 2; ++k) points.emplace_back(0.1 * i, 0.1 * k, tinyHeight(0.1 * i, 0.1 * k));
  return points;
}

void writeBundlerSample(const fs::path& folder) {
  writePhotographs(folder / "photographs");
  fs::create_directories(folder / "bundle");
  std::ostringstream text = preciseText(), list;
  text << "# Bundle file v0.3\n5 35\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";
  list << "./photographs/lost.png\n";
  for (const Photograph& photograph : tinyPhotographs()) {
    const RigidTransform p = photograph.world_from_camera.inverse();
    const Eigen::Vector3d flip(1, -1, -1);
    text << "22.5 -0.05 0.01\n"
         << flip.asDiagonal() * p.linear() << "\n"
         << p.translation().cwiseProduct(flip).transpose() << "\n";
    list << "./photographs/" << photograph.name << ".png 0 22.5\n";
  }
  for (const Eigen::Vector3d& point : tinyPoints())
    text << point.transpose() << "\n255 128 0\n4 1 7 0.5 -3 2 8 1.5 4 3 0 0 0 4 1 1 1\n";
  writeText(folder / "bundle/bundle.out", text.str());
  writeText(folder / "list.txt", list.str());
}

void writeNvmSample(const fs::path& folder) {
  writePhotographs(folder / "my photographs");
  std::ostringstream text = preciseText();
  text << "NVM_V3 \n\n4\n";
  for (const Photograph& photograph : tinyPhotographs()) {
    const Eigen::Quaterniond q(Eigen::Matrix3d(photograph.world_from_camera.linear().transpose()));
    text << "my\"photographs/" << photograph.name << ".png\t22.5 " << q.w() << " " << q.vec().transpose()
         << " " << photograph.world_from_camera.translation().transpose() << " 0.05 0\n";
  }
  text << "\n35\n";
  for (const Eigen::Vector3d& point : tinyPoints())
    text << point.transpose() << " 255 128 0 4 0 7 0.5 -3 1 8 1.5 4 2 0 0 0 3 1 1 1\n";
  text << "\n0\n\n# comment\n";
  writeText(folder / "model.nvm", text.str());
}

void writeColmapPointsSample(const fs::path& folder) {
  writePhotographs(folder / "images");
  fs::create_directories(folder / "sparse/0");
  const std::vector<double> lens = {22.5, 12, 9, -0.05, 0.01};
  writeText(folder / "sparse/0/cameras.bin", raw<std::uint64_t>(1) + raw<std::uint32_t>(6) +
                                                 raw<std::int32_t>(3) + raw<std::uint64_t>(24) +
                                                 raw<std::uint64_t>(18) + bytesOf<double>(lens));
  std::string images = raw<std::uint64_t>(4), points = raw<std::uint64_t>(35), track = raw<std::uint64_t>(4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Photograph photograph = tinyPhotographs()[i];
    const RigidTransform p = photograph.world_from_camera.inverse();
    const Eigen::Quaterniond q(p.linear());
    const Eigen::Vector3d t = p.translation();
    images += raw(10 + i) +
              bytesOf<double>(std::vector<double>{q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) +
              raw<std::uint32_t>(6) + photograph.name + ".png" + std::string(1, '\0') +
              raw<std::uint64_t>(1) + std::string(24, 'x');
    track += raw(10 + i) + raw<std::uint32_t>(0);
  }
  std::uint64_t id = 1;
  for (const Eigen::Vector3d& point : tinyPoints())
    points += raw(id++) + bytesOf<double>(std::vector<double>{point.x(), point.y(), point.z()}) + "rgb" +
              raw(-1.0) + track;
  writeText(folder / "sparse/0/images.bin", images);
  writeText(folder / "sparse/0/points3D.bin", points);
}

const std::vector<Sample>& imageSamples() {
  static const std::vector<Sample> all = {
      {"middlebury", "written", writeAs<kMiddlebury>, ""},
      {"mvsnet", "written", writeAs<kMvsnet>, ""},
      {"transforms", "written", writeAs<kTransforms>, "transforms.json"},
      {"colmap", "text", writeAs<kColmap>, ""},
      {"colmap", "binary", writeBinaryColmap, "sparse"},
      {"colmap", "rig", writeColmapRig, ""},
      {"colmap", "points", writeColmapPointsSample, ""},
      {"strecha", "written", writeAs<kStrecha>, ""},
      {"bundler", "written", writeAs<kBundler>, ""},
      {"bundler", "points", writeBundlerSample, "bundle"},
      {"nvm", "written", writeAs<kNvm>, ""},
      {"nvm", "points", writeNvmSample, "model.nvm"},
  };
  return all;
}

}  // namespace vdbfuse::test
