// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/formats/depth_set.h"

#include <cmath>

#include "formats/arkit.h"
#include "formats/colmap.h"
#include "formats/e57.h"
#include "formats/format_table.h"
#include "formats/kitti.h"
#include "formats/masks.h"
#include "formats/mvsnet_format.h"
#include "formats/numpy.h"
#include "formats/open3d.h"
#include "formats/pcd.h"
#include "formats/points.h"
#include "formats/ptx.h"
#include "formats/rgbd_folder.h"
#include "formats/scannet.h"
#include "formats/sens.h"
#include "formats/stanford.h"
#include "formats/transforms.h"
#include "formats/tum.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
std::vector<std::string> validate(const ReadOptions& options) {
  std::vector<std::string> problems;
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (options.depth_scale && !positive(*options.depth_scale))
    problems.emplace_back("depth_scale must be above 0");
  if (options.baseline && !positive(*options.baseline)) problems.emplace_back("baseline must be above 0");
  if (options.depth_kind == DepthKind::Disparity && !options.baseline)
    problems.emplace_back("depth_kind disparity needs a baseline");
  if (options.splat_step && !(positive(*options.splat_step) && *options.splat_step < 0.5))
    problems.emplace_back("splat_step must be above 0 and below 0.5");
  if (options.intrinsics) {
    const auto& [fx, fy, cx, cy] = *options.intrinsics;
    if (!(positive(fx) && positive(fy) && std::isfinite(cx) && std::isfinite(cy)))
      problems.emplace_back("intrinsics must be fx, fy, cx, cy with fx and fy above 0");
  }
  if (!(options.min_depth >= 0)) problems.emplace_back("min_depth must not be below 0");
  if (!(options.max_depth > options.min_depth)) problems.emplace_back("max_depth must be above min_depth");
  return problems;
}

const std::vector<DepthSetFormat>& depthSetFormats() {
  static const std::vector<DepthSetFormat> formats = {
      // Depth cameras.
      rgbdFormat(), tumFormat(), open3dFormat(), scannetFormat(), sensFormat(), arkitFormat(),
      // Stereo and networks.
      mvsnetFormat(), colmapFormat(), transformsFormat(), numpyFormat(),
      // Scanners.
      pcdFormat(), ptxFormat(), e57Format(), stanfordFormat(), kittiFormat(), pointsFormat()};
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
  const DepthSetFormat& format = options.format.empty() ? bestFormat(depthSetFormats(), path, "a data set")
                                                        : formatNamed(depthSetFormats(), options.format);
  DepthSet set = format.read(path, options);
  set.format = format.name;
  addMasks(set, path, options.masks);
  return set;
}

void writeDepthSet(const std::filesystem::path& folder, const std::string& format, const ViewSequence& views,
                   const WriteOptions& options, const Progress& progress) {
  const DepthSetFormat& target = formatNamed(depthSetFormats(), format);
  if (target.write == nullptr)
    throw InvalidArgument("format", "expected one that can be written (" +
                                        formatNames(depthSetFormats(), Ability::Write) + "), found '" +
                                        format + "', which can be read only");
  if (views.empty()) throw InvalidArgument("views", "expected at least one view, found none");
  if (options.depth_scale && !(*options.depth_scale > 0 && std::isfinite(*options.depth_scale)))
    throw InvalidArgument("depth_scale", "expected a number above 0");
  requireEmptyFolder(folder);
  target.write(folder, views, options, progress);
}

}  // namespace vdbfuse
