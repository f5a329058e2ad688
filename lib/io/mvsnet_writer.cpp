// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

#include "io/file_bytes.h"
#include "io/mvsnet_camera.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/distortion.h"
#include "vdbfuse/io/mvsnet.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

std::string eightDigits(std::size_t index) {
  std::ostringstream text;
  text << std::setw(8) << std::setfill('0') << index;
  return text.str();
}

void createFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(folder, "the folder cannot be created: " + error.message());
  if (!std::filesystem::is_directory(folder)) throw IoError(folder, "", "a folder to write to", "a file");
}

const Pinhole& plainPinhole(const View& view) {
  const auto* camera = std::get_if<Pinhole>(&view.projection);
  if (camera == nullptr || isDistorted(*camera))
    throw InvalidArgument("view " + view.name, "the MVSNet layout holds pinholes without distortion only");
  const std::vector<std::string> problems = validate(view);
  if (!problems.empty()) throw InvalidArgument("view " + view.name, problems.front());
  return *camera;
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

}  // namespace

MvsnetWriter::MvsnetWriter(std::filesystem::path folder) : folder_(std::move(folder)) {
  createFolder(folder_ / "cams");
  createFolder(folder_ / "depth_est");
}

void MvsnetWriter::add(const View& view) {
  const Pinhole& camera = plainPinhole(view);
  const std::string stem = eightDigits(count_);
  const auto [low, high] = depthRange(view.map.depth);
  const std::string text = mvsnetCameraText(camera, view.world_from_camera, low, high);
  writePfm(folder_ / "depth_est" / (stem + ".pfm"), view.map.depth);
  if (!view.map.confidence.empty()) {
    createFolder(folder_ / "confidence");
    writePfm(folder_ / "confidence" / (stem + ".pfm"), view.map.confidence);
  }
  if (!view.map.color.empty()) {
    createFolder(folder_ / "images");
    writePng(folder_ / "images" / (stem + ".png"), view.map.color);
  }
  io::writeFileBytes(folder_ / "cams" / (stem + "_cam.txt"), text);
  ++count_;
}

}  // namespace vdbfuse
