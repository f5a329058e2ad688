// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/image_writer.h"
#include "formats/mvsnet_camera.h"
#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

Pinhole checkedPinhole(const View& view) {
  const Pinhole camera = plainPinhole(view, "mvsnet");
  const std::vector<std::string> problems = validate(view);
  if (!problems.empty()) throw InvalidArgument("view " + view.name, problems.front());
  return camera;
}

// Smallest and largest valid depth; zeros when there is none.
std::pair<float, float> depthRange(const Image<float>& depth) {
  float low = 0, high = 0;
  for (const float d : depth) {
    if (d == kInvalidDepth) continue;
    low = low == 0 ? d : std::min(low, d);
    high = std::max(high, d);
  }
  return {low, high};
}

void writePicture(const std::filesystem::path& path, const Photograph& photograph) {
  if (!photograph.color.empty()) return writePng(path, photograph.color);
  const Image<float>& brightness = photograph.brightness;
  Image<std::uint8_t> grey(brightness.width(), brightness.height());
  std::transform(brightness.begin(), brightness.end(), grey.begin(), greyLevel);
  writePng(path, grey);
}

}  // namespace

MvsnetWriter::MvsnetWriter(std::filesystem::path folder) : folder_(std::move(folder)) {
  createFolder(folder_ / "cams");
}

void MvsnetWriter::add(const View& view) {
  const Pinhole camera = checkedPinhole(view);
  const std::string stem = numberedName(count_, 8);
  const auto [low, high] = depthRange(view.map.depth);
  const std::string text = mvsnetCameraText(camera, view.world_from_camera, low, high);
  createFolder(folder_ / "depth_est");
  writePfm(folder_ / "depth_est" / (stem + ".pfm"), view.map.depth);
  if (!view.map.confidence.empty()) {
    createFolder(folder_ / "confidence");
    writePfm(folder_ / "confidence" / (stem + ".pfm"), view.map.confidence);
  }
  if (!view.map.color.empty() && !view.color_sensor) {
    createFolder(folder_ / "images");
    writeColor(folder_ / "images" / (stem + ".png"), view);
  }
  io::writeFileBytes(folder_ / "cams" / (stem + "_cam.txt"), text);
  ++count_;
}

void MvsnetWriter::add(const Photograph& photograph) {
  const std::vector<std::string> problems = validate(photograph);
  if (!problems.empty()) throw InvalidArgument("photograph " + photograph.name, problems.front());
  const std::string stem = numberedName(count_, 8);
  const DepthInterval depth = photograph.depth.value_or(DepthInterval{});
  createFolder(folder_ / "images");
  writePicture(folder_ / "images" / (stem + ".png"), photograph);
  io::writeFileBytes(
      folder_ / "cams" / (stem + "_cam.txt"),
      mvsnetCameraText(photograph.camera, photograph.world_from_camera, depth.near, depth.far));
  ++count_;
}

}  // namespace vdbfuse
