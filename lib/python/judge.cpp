// SPDX-License-Identifier: Apache-2.0
// vdbfuse.judge(): what each pixel is worth.
#include <filesystem>
#include <string>

#include "python/arrays.h"
#include "python/data_set.h"
#include "python/fuse_options.h"
#include "python/long_call.h"
#include "python/module.h"
#include "python/report.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse::python {
namespace {

namespace fs = std::filesystem;

struct JudgedSet {
  JudgedScan scan;
  std::string format;
};
using JudgedPointer = std::shared_ptr<JudgedSet>;

JudgementOrigin originOf(const JudgedSet& judged) { return {version(), "", judged.format}; }

JudgedPointer judgeData(const DataSet& data, const py::object& progress, const py::kwargs& keywords) {
  FuseRequest request;
  applyOptions("judge", sensorOptions(), keywords, request);
  if (!request.options.noise && request.options.noise_scale == 0) request.options.noise = data.noise;
  return longCall(progress, [&](const Progress& inner) {
    const ThreadLimit threads(request.threads);
    return std::make_shared<JudgedSet>(
        JudgedSet{judgeScan(data.set.views, request.options, inner), data.set.format});
  });
}

// The view lives as long as its scan.
std::shared_ptr<JudgedView> viewOf(const JudgedPointer& judged, py::ssize_t index) {
  std::vector<JudgedView>& views = judged->scan.judgement.judged.views;
  const auto size = static_cast<py::ssize_t>(views.size());
  if (index < 0) index += size;
  if (index < 0 || index >= size) throw py::index_error("there is no view of that number");
  return {judged, &views[static_cast<std::size_t>(index)]};
}

void save(const JudgedSet& judged, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder, "cannot be created: " + error.message());
  if (!fs::is_empty(folder)) throw IoError(folder, "holds something already");
  writeJudgement(folder, judged.scan, originOf(judged));
}

py::dict judgementReport(const JudgedSet& judged) {
  const std::string text = judgementJson(judged.scan, originOf(judged));
  py::dict report = py::module_::import("json").attr("loads")(text);
  report["steps"] = stepsOf(judged.scan.steps);
  return report;
}

py::object imageOf(const py::object& self, Image<float> JudgedView::*image) {
  return arrayOf(self, self.cast<const JudgedView&>().*image);
}

void bindJudgedView(py::module_& module) {
  py::class_<JudgedView, std::shared_ptr<JudgedView>>(
      module, "JudgedView", "What each pixel of a view is worth. Arrays are read-only views, not copies.")
      .def_property_readonly("name", [](const JudgedView& self) { return self.name; })
      .def_property_readonly(
          "depth", [](const py::object& self) { return imageOf(self, &JudgedView::depth); },
          "(H, W) float32: 0 where nothing was measured.")
      .def_property_readonly(
          "outlier", [](const py::object& self) { return imageOf(self, &JudgedView::outlier); },
          "(H, W) float32 in (0, 1): probability that the depth has nothing to do with the surface. Of no "
          "meaning where there is no depth.")
      .def_property_readonly(
          "incidence", [](const py::object& self) { return imageOf(self, &JudgedView::incidence); },
          "(H, W) float32: cosine between ray and surface normal, 0 where that is not known.")
      .def_property_readonly(
          "weight", [](const JudgedView& self) { return self.weight; },
          "In (0, 1]: how much of the view is not a repetition of its neighbours.")
      .def("__repr__", [](const JudgedView& self) { return "<vdbfuse.JudgedView '" + self.name + "'>"; });
}

}  // namespace

void bindJudge(py::module_& module) {
  bindJudgedView(module);
  py::class_<JudgedSet, JudgedPointer>(module, "Judgement", "A sequence of JudgedView.")
      .def("__len__", [](const JudgedSet& self) { return self.scan.judgement.judged.views.size(); })
      .def("__getitem__", viewOf, "index"_a)
      .def_property_readonly("report", judgementReport,
                             "dict: sensor, calibration, learned curve of the confidence, weights of the "
                             "views, as in judgement.json.")
      .def(
          "__str__", [](const JudgedSet& self) { return judgementText(self.scan); }, "judgement.txt.")
      .def("save", save, "folder"_a, py::call_guard<py::gil_scoped_release>(),
           "Writes pictures, judgement.json and judgement.txt into a new or empty folder; "
           "fuse(..., judgement=folder) takes it in place of judging again.");
  module.def("judge", judgeData, "data"_a, "progress"_a);
  module.def("judge_option_names", [] { return namesOf(sensorOptions()); });
}

}  // namespace vdbfuse::python
