// SPDX-License-Identifier: Apache-2.0
#include "fuse_photographs.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "stereo_arguments.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse::tool {
namespace {

void refuseDepthOptions(const ReadArguments& read) {
  const auto refuse = [](bool given, const char* name) {
    if (given) throw InvalidArgument(name, "the input is photographs, which hold no depths");
  };
  refuse(read.depth_scale.has_value(), "--depth-scale");
  refuse(read.depth_kind.has_value(), "--depth-kind");
  refuse(read.baseline.has_value(), "--baseline");
  refuse(read.intrinsics.has_value(), "--intrinsics");
  refuse(read.splat_step.has_value(), "--splat-step");
  refuse(read.fix_convention != "none", "--fix-convention");
}

StereoOptions resolved(const StereoOptions& given, const ReadArguments& read,
                       const std::optional<Box>& domain) {
  StereoOptions options = given;
  options.domain = domain;
  options.min_depth = read.min_depth;
  if (std::isfinite(read.max_depth)) options.max_depth = read.max_depth;
  return options;
}

DepthSet depthSetOf(StereoResult result, ImageSet images) {
  std::vector<View> views;
  for (StereoView& view : result.views) views.push_back(std::move(view.view));
  DepthSet set;
  set.views = ViewSequence::fromViews(std::move(views));
  set.format = std::move(images.format);
  set.reading = {"photographs", DepthKind::Z, 1.0, "0", std::move(images.pose)};
  set.notes = std::move(images.notes);
  return set;
}

}  // namespace

void addPhotographOptions(CLI::App& app, PhotographArguments& arguments) {
  const char* group = "From photographs";
  arguments.given = addStereoOptions(app, arguments.stereo, group);
  app.add_flag("--from-images", arguments.forced,
               "Take the input as photographs, where it could be depth maps as well")
      ->group(group);
}

bool takesPhotographs(const std::filesystem::path& input, const SensorArguments& sensor,
                      const PhotographArguments& arguments) {
  if (arguments.forced || kindOf(input, sensor.read.format) == InputKind::Photographs) {
    refuseDepthOptions(sensor.read);
    return true;
  }
  for (const CLI::Option* option : arguments.given) {
    if (option->count() > 0)
      throw InvalidArgument(option->get_name(), "the input is depth maps, which are matched already");
  }
  return false;
}

MatchedScan matchPhotographs(const std::filesystem::path& input, const SensorArguments& sensor,
                             const PhotographArguments& arguments, ReconstructOptions& options, Words words,
                             const Progress& progress) {
  ImageSet images = readPhotographs(input, {sensor.read.format, sensor.read.masks}, sensor.views);
  if (words == Words::Print)
    for (const std::string& note : images.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  StereoResult result =
      computeDepthMaps(images.photographs, resolved(arguments.stereo, sensor.read, options.domain), progress);
  StereoSummary summary = summarise(result);
  if (words == Words::Print) std::fprintf(stderr, "%s", tableOf(summary).c_str());
  if (!options.noise && options.noise_scale == 0) options.noise = medianNoise(result);
  options.window_px = arguments.stereo.window_px;
  return {depthSetOf(std::move(result), std::move(images)), std::move(summary)};
}

}  // namespace vdbfuse::tool
