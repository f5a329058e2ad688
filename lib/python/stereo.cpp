// SPDX-License-Identifier: Apache-2.0
// vdbfuse.stereo(): photographs with cameras to depth maps.
#include "vdbfuse/stereo/stereo.h"

#include <filesystem>
#include <string>
#include <vector>

#include "python/arrays.h"
#include "python/data_set.h"
#include "python/long_call.h"
#include "python/module.h"
#include "python/options.h"
#include "python/views.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse::python {
namespace {

struct StereoRequest {
  StereoOptions stereo;
  ImageReadOptions read;
  std::size_t views = 0;  ///< the first ones only; 0: all
  int threads = 0;
};

using R = StereoRequest;
using V = OptionValue;

const std::vector<Option<StereoRequest>>& stereoOptions() {
  using Mode = StereoOptions::Mode;
  static const std::vector<Option<R>> options = {
      {"mode",
       [](R& r, const V& v) {
         r.stereo.mode = v.choice<Mode>({{"fast", Mode::Fast}, {"paper", Mode::Paper}});
       }},
      {"neighbours", [](R& r, const V& v) { r.stereo.partners.count = v.count(); }},
      {"min_angle", [](R& r, const V& v) { r.stereo.partners.min_angle_deg = v.number(); }},
      {"max_angle", [](R& r, const V& v) { r.stereo.partners.max_angle_deg = v.number(); }},
      {"window", [](R& r, const V& v) { r.stereo.window_px = v.whole(); }},
      {"hypotheses", [](R& r, const V& v) { r.stereo.hypotheses = v.whole(); }},
      {"min_confidence", [](R& r, const V& v) { r.stereo.min_confidence = v.number(); }},
      {"surface_sweeps", [](R& r, const V& v) { r.stereo.surface_sweeps = v.whole(); }},
      {"no_cross_check",
       [](R& r, const V& v) {
         if (v.flag()) r.stereo.cross_check = StereoOptions::CrossCheck::Off;
       }},
      {"bbox", [](R& r, const V& v) { r.stereo.domain = v.box(); }},
      {"min_depth", [](R& r, const V& v) { r.stereo.min_depth = v.number(); }},
      {"max_depth", [](R& r, const V& v) { r.stereo.max_depth = v.positive(); }},
      {"format", [](R& r, const V& v) { r.read.format = v.text(); }},
      {"masks", [](R& r, const V& v) { r.read.masks = v.path(); }},
      {"views", [](R& r, const V& v) { r.views = v.count(); }},
      {"threads", [](R& r, const V& v) { r.threads = static_cast<int>(v.count()); }},
  };
  return options;
}

StereoRequest requestOf(const py::kwargs& keywords) {
  StereoRequest request;
  applyOptions("stereo", stereoOptions(), keywords, request);
  return request;
}

py::list reportOf(const StereoResult& result) {
  py::list report;
  for (const StereoView& view : result.views) {
    std::vector<std::string> partners;
    for (const std::size_t partner : view.partners) partners.push_back(result.views[partner].view.name);
    report.append(py::dict("name"_a = view.view.name, "partners"_a = partners, "near"_a = view.depths.near,
                           "far"_a = view.depths.far, "matching_error_px"_a = view.matching_error_px,
                           "noise_quadratic"_a = view.noise.quadratic));
  }
  return report;
}

DataSetPointer dataSetOf(StereoResult result, const StereoRequest& request) {
  py::object report = reportOf(result);
  const std::optional<NoiseLaw> noise = medianNoise(result);
  std::vector<View> views;
  for (StereoView& view : result.views) views.push_back(std::move(view.view));
  DataSetPointer data = makeDataSet(ViewSequence::fromViews(std::move(views)), "photographs");
  data->set.reading = {"photographs", DepthKind::Z, 1.0, "0", "world_from_camera"};
  data->noise = noise, data->window_px = request.stereo.window_px;
  data->report = hold(std::move(report));
  return data;
}

DataSetPointer fromPath(const std::filesystem::path& path, const py::object& progress,
                        const py::kwargs& keywords) {
  const StereoRequest request = requestOf(keywords);
  ImageSet images;
  StereoResult result = longCall(progress, [&](const Progress& inner) {
    const ThreadLimit threads(request.threads);
    images = readImageSet(path, request.read);
    if (request.views > 0) images.photographs = images.photographs.first(request.views);
    return computeDepthMaps(images.photographs, request.stereo, inner);
  });
  DataSetPointer data = dataSetOf(std::move(result), request);
  data->set.format = images.format, data->set.reading.pose = images.pose, data->set.notes = images.notes;
  return data;
}

// arrays: of each photograph (grey, color, mask), one of the first two None: (H, W) float32 brightness in
// [0, 1], (H, W, 3) uint8, (H, W) uint8.
DataSetPointer fromArrays(const std::vector<py::tuple>& arrays, const std::vector<std::string>& names,
                          const py::array_t<double>& cameras, const py::array_t<double>& poses,
                          bool is_camera_from_world, bool has_opengl_axes, const py::object& progress,
                          const py::kwargs& keywords) {
  const StereoRequest request = requestOf(keywords);
  std::vector<Photograph> photographs(arrays.size());
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    Photograph& photograph = photographs[i];
    photograph.name = names[i];
    photograph.color = colorImage(arrays[i][1]);
    photograph.brightness =
        photograph.color.empty() ? floatImage(arrays[i][0]) : brightnessOf(photograph.color);
    photograph.mask = byteImage(arrays[i][2]);
    const py::array_t<double> camera(cameras[py::int_(i)]), pose(poses[py::int_(i)]);
    photograph.camera = pinholeOf(camera, photograph.brightness.width(), photograph.brightness.height());
    photograph.world_from_camera =
        poseOf("poses[" + std::to_string(i) + "]", pose, {is_camera_from_world, has_opengl_axes});
  }
  return dataSetOf(longCall(progress,
                            [&](const Progress& inner) {
                              const ThreadLimit threads(request.threads);
                              return computeDepthMaps(
                                  PhotographSequence::fromPhotographs(std::move(photographs)), request.stereo,
                                  inner);
                            }),
                   request);
}

}  // namespace

void bindStereo(py::module_& module) {
  module.def("stereo_from_path", fromPath, "path"_a, "progress"_a);
  module.def("stereo_from_arrays", fromArrays, "arrays"_a, "names"_a, "cameras"_a, "poses"_a,
             "is_camera_from_world"_a, "has_opengl_axes"_a, "progress"_a);
  module.def("stereo_option_names", [] { return namesOf(stereoOptions()); });
}

}  // namespace vdbfuse::python
