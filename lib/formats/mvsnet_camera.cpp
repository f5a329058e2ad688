// SPDX-License-Identifier: Apache-2.0
#include "formats/mvsnet_camera.h"

#include <cmath>

#include "formats/camera_text.h"
#include "formats/image_writer.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse {
namespace {

constexpr int kDepthIntervals = 192;

void expectWord(const std::filesystem::path& path, std::span<const TextLine> lines, std::size_t index,
                const std::string& word) {
  if (index >= lines.size())
    throw IoError(path, linePlace(lines, index), "'" + word + "'", "the end of the file");
  const std::string& found = lines[index].words.front();
  if (found != word || lines[index].words.size() != 1)
    throw IoError(path, linePlace(lines, index), "'" + word + "'", "'" + found + "'");
}

DepthInterval readDepthLine(const std::filesystem::path& path, std::span<const TextLine> lines,
                            std::size_t index) {
  const char* expected = "2 to 4 numbers (smallest depth, interval, ...)";
  if (index >= lines.size()) throw IoError(path, linePlace(lines, index), expected, "the end of the file");
  const std::vector<double> numbers = finiteNumbers(path, lines[index]);
  const std::size_t count = numbers.size();
  if (count < 2 || count > 4) throw IoError(path, linePlace(lines, index), expected, std::to_string(count));
  const double intervals = count > 2 ? numbers[2] : kDepthIntervals;
  return {numbers[0], count > 3 ? numbers[3] : numbers[0] + numbers[1] * (intervals - 1)};
}

// Width of the image in whose middle the principal point would lie, per width of the depth map.
double impliedRatio(double centre, int pixels) { return (2.0 * centre + 1.0) / pixels; }

bool roughlyInTheMiddle(double ratio) { return ratio > 0.6 && ratio < 1.4; }
bool inTheMiddle(double ratio) { return ratio > 0.8 && ratio < 1.25; }

// What fitToDepthMap() multiplies the intrinsics by.
std::optional<double> intrinsicsScale(const Pinhole& camera, const PfmHeader& depth_map,
                                      std::optional<double> depth_per_picture) {
  const double x = impliedRatio(camera.cx, depth_map.width);
  const double y = impliedRatio(camera.cy, depth_map.height);
  if (roughlyInTheMiddle(x) || roughlyInTheMiddle(y)) return 1.0;
  const auto fits = [&](double scale) { return inTheMiddle(x * scale) && inTheMiddle(y * scale); };
  if (depth_per_picture && fits(*depth_per_picture)) return depth_per_picture;
  if (x > 0 && y > 0) {
    const double power_of_two = std::exp2(-std::round(std::log2(std::sqrt(x * y))));
    if (fits(power_of_two)) return power_of_two;
  }
  const bool inside =
      camera.cx >= 0 && camera.cy >= 0 && camera.cx < depth_map.width && camera.cy < depth_map.height;
  return inside ? std::optional(1.0) : std::nullopt;
}

}  // namespace

MvsnetCamera readMvsnetCamera(const std::filesystem::path& path) {
  const std::vector<TextLine> lines = readTextLines(path);
  expectWord(path, lines, 0, "extrinsic");
  const Eigen::MatrixXd extrinsic = readMatrix(path, lines, 1, 4, 4, "a 4x4 extrinsic matrix");
  expectWord(path, lines, 5, "intrinsic");
  const Eigen::MatrixXd intrinsic = readMatrix(path, lines, 6, 3, 3, "a 3x3 intrinsic matrix");
  MvsnetCamera camera;
  camera.depths = readDepthLine(path, lines, 9);
  camera.world_from_camera = poseFromMatrix(path, linePlace(lines, 1), extrinsic).inverse();
  camera.intrinsics_place = linePlace(lines, 6);
  camera.pinhole = pinholeFromMatrix(path, camera.intrinsics_place, intrinsic, 0, 0);
  return camera;
}

std::optional<FittedCamera> fitToDepthMap(const Pinhole& camera, const PfmHeader& depth_map,
                                          std::optional<double> depth_per_picture) {
  const std::optional<double> scale = intrinsicsScale(camera, depth_map, depth_per_picture);
  if (!scale) return std::nullopt;
  FittedCamera fitted{camera, *scale};
  Pinhole& pinhole = fitted.pinhole;
  pinhole.width = depth_map.width, pinhole.height = depth_map.height;
  pinhole.fx *= fitted.scale, pinhole.fy *= fitted.scale;
  pinhole.cx = (pinhole.cx + 0.5) * fitted.scale - 0.5, pinhole.cy = (pinhole.cy + 0.5) * fitted.scale - 0.5;
  return fitted;
}

std::string mvsnetCameraText(const Pinhole& camera, const RigidTransform& world_from_camera, double min_depth,
                             double max_depth) {
  const Eigen::Matrix3d intrinsic = intrinsicMatrix(camera);
  const RigidTransform camera_from_world = world_from_camera.inverse();
  const double interval = (max_depth - min_depth) / (kDepthIntervals - 1);
  return "extrinsic\n" + matrixText(camera_from_world.matrix()) + "\nintrinsic\n" + matrixText(intrinsic) +
         "\n" + exactText(min_depth) + " " + exactText(interval) + " " + std::to_string(kDepthIntervals) +
         " " + exactText(max_depth) + "\n";
}

}  // namespace vdbfuse
