// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/depth_set.h"

#include <algorithm>
#include <cmath>

#include "io/masks.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/mvsnet.h"
#include "vdbfuse/io/pcd.h"
#include "vdbfuse/io/rgbd_folder.h"

namespace vdbfuse {
namespace {

std::string formatNames() {
  std::string names;
  for (const DepthSetFormat& format : depthSetFormats()) {
    if (!names.empty()) names += ", ";
    names += format.name;
  }
  return names;
}

const DepthSetFormat& formatNamed(const std::string& name) {
  for (const DepthSetFormat& format : depthSetFormats()) {
    if (format.name == name) return format;
  }
  throw InvalidArgument("format", "expected one of " + formatNames() + ", found '" + name + "'");
}

const DepthSetFormat& bestFormat(const std::filesystem::path& path) {
  const DepthSetFormat* best = nullptr;
  Detection::Fit best_fit = Detection::Fit::No;
  std::string missing;
  for (const DepthSetFormat& format : depthSetFormats()) {
    const Detection found = format.detect(path);
    if (found.fit > best_fit) best = &format, best_fit = found.fit;
    missing += (missing.empty() ? "" : "; ") + std::string(format.name) + ": " + found.reason;
  }
  if (best == nullptr) throw IoError(path, "", "a data set of a known format", "none (" + missing + ")");
  return *best;
}

}  // namespace

std::vector<std::string> validate(const ReadOptions& options) {
  std::vector<std::string> problems;
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (options.depth_scale && !positive(*options.depth_scale))
    problems.emplace_back("depth_scale must be above 0");
  if (options.baseline && !positive(*options.baseline)) problems.emplace_back("baseline must be above 0");
  if (options.depth_kind == DepthKind::Disparity && !options.baseline)
    problems.emplace_back("depth_kind disparity needs a baseline");
  if (!(options.min_depth >= 0)) problems.emplace_back("min_depth must not be below 0");
  if (!(options.max_depth > options.min_depth)) problems.emplace_back("max_depth must be above min_depth");
  return problems;
}

const std::vector<DepthSetFormat>& depthSetFormats() {
  static const std::vector<DepthSetFormat> formats = {
      {"rgbd", "frames of a depth camera in one folder",
       "NAME.depth.png         16-bit grey, millimetres (--depth-scale 0.001), 0 and 65535 invalid\n"
       "NAME.pose.txt          4x4 or 3x4 matrix world_from_camera\n"
       "NAME.color.png|jpg     optional\n"
       "NAME.mask.png          optional, 8 bit, black where the object is not; or masks/NAME.png\n"
       "*intrinsics*.txt       3x3 matrix, the same for all frames\n",
       detectRgbdFolder, readRgbdFolder},
      {"mvsnet", "depth maps of multi-view stereo in the folders of MVSNet",
       "cams/00000000_cam.txt     'extrinsic' 4x4 camera_from_world, 'intrinsic' 3x3, smallest depth and "
       "interval\n"
       "depth_est/00000000.pfm    z, 0 invalid\n"
       "confidence/00000000.pfm   optional\n"
       "images/00000000.png|jpg   optional\n"
       "masks/00000000.png        optional, 8 bit, black where the object is not\n",
       detectMvsnet, readMvsnet},
      {"pcd", "organised point clouds of the Point Cloud Library, one file or a folder",
       "NAME.pcd   ascii, binary or compressed; x y z as 4-byte floats in the sensor's frame; HEIGHT above "
       "1;\n"
       "           VIEWPOINT is world_from_camera\n",
       detectPcd, readPcd},
  };
  return formats;
}

DepthSet readDepthSet(const std::filesystem::path& path, const ReadOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) {
    std::string all = problems.front();
    for (std::size_t i = 1; i < problems.size(); ++i) all += "; " + problems[i];
    throw InvalidArgument("options", all);
  }
  if (!std::filesystem::exists(path))
    throw IoError(path, "", "a data set of depth maps", "nothing of that name");
  const DepthSetFormat& format = options.format.empty() ? bestFormat(path) : formatNamed(options.format);
  DepthSet set = format.read(path, options);
  set.format = format.name;
  addMasks(set, path, options.masks);
  return set;
}

}  // namespace vdbfuse
