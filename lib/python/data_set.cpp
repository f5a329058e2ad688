// SPDX-License-Identifier: Apache-2.0
#include "python/data_set.h"

#include <cmath>
#include <string>
#include <vector>

#include "python/arrays.h"
#include "python/long_call.h"
#include "python/module.h"
#include "python/read_options.h"
#include "python/view_source.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/fusion/conventions.h"

namespace vdbfuse::python {
namespace {

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

// The reading that is asked for; the views may have to be looked at.
std::optional<Convention> wantedConvention(DepthSet& set, const std::string& name, const Progress& progress) {
  if (name == "none") return std::nullopt;
  if (name != "auto") return conventionNamed(name);
  const ConventionCheck check = checkConvention(set.views, set.stored_from_camera, {}, progress);
  return check.better ? std::optional(check.better->convention) : std::nullopt;
}

DepthSet readAs(const std::filesystem::path& path, const ReadRequest& request, ReadOptions::Color color) {
  ReadOptions options = request;
  options.color = color;
  return readDepthSet(path, options);
}

ViewSequence understood(const DepthSet& set, const std::optional<Convention>& convention, std::size_t views) {
  ViewSequence all = convention ? underConvention(set.views, set.stored_from_camera, *convention) : set.views;
  return views > 0 ? all.first(views) : all;
}

DataSet readData(const std::filesystem::path& path, const ReadRequest& request, const Progress& progress) {
  DataSet data{readAs(path, request, ReadOptions::Color::Skip), nullptr};
  const std::optional<Convention> convention = wantedConvention(data.set, request.fix_convention, progress);
  data.set.views = understood(data.set, convention, request.views);
  if (convention) data.set.notes.push_back("taken as " + nameOf(*convention) + ": " + describe(*convention));
  data.pictures = [=] {
    return understood(readAs(path, request, ReadOptions::Color::Load), convention, request.views);
  };
  return data;
}

DataSetPointer read(const std::filesystem::path& path, const py::object& progress,
                    const py::kwargs& keywords) {
  ReadRequest request;
  applyOptions("read", readOptions(), keywords, request);
  return std::make_shared<DataSet>(
      longCall(progress, [&](const Progress& inner) { return readData(path, request, inner); }));
}

void write(const std::filesystem::path& folder, const DataSet& data, const std::string& format,
           std::optional<double> depth_scale, const py::object& progress) {
  runLong(progress, [&](const Progress& inner) {
    writeDepthSet(folder, format, data.pictures(), {depth_scale}, inner);
  });
}

// No other convention is tried where the views agree well enough.
py::object conventionHint(const DataSet& data, const py::object& progress) {
  const ConventionCheck check = longCall(progress, [&](const Progress& inner) {
    ConventionOptions options;
    options.enough = 0.6;
    return checkConvention(data.set.views, data.set.stored_from_camera, options, inner);
  });
  if (!check.better) return py::none();
  return py::str("the views disagree with each other (" + percent(*check.agreement) +
                 " of the points agree); " + percent(check.better->agreement) + " would, if " +
                 describe(check.better->convention) + " (fix_convention='" +
                 nameOf(check.better->convention) + "')");
}

std::shared_ptr<View> viewOf(const DataSet& data, py::ssize_t index) {
  const auto size = static_cast<py::ssize_t>(data.set.views.size());
  if (index < 0) index += size;
  if (index < 0 || index >= size) throw py::index_error("there is no view of that number");
  const py::gil_scoped_release unlocked;
  return std::make_shared<View>(data.pictures().load(static_cast<std::size_t>(index)));
}

DataSetPointer firstOf(const DataSet& data, std::size_t count) {
  auto first = std::make_shared<DataSet>(data);
  first->set.views = data.set.views.first(count);
  first->pictures = [all = data.pictures, count] { return all().first(count); };
  return first;
}

py::dict readingOf(const DataSet& data) {
  const DepthReading& reading = data.set.reading;
  return py::dict("stored"_a = reading.stored,
                  "depth_kind"_a = reading.kind ? py::object(py::str(nameOf(*reading.kind))) : py::none(),
                  "depth_scale"_a = reading.scale, "invalid"_a = reading.invalid, "pose"_a = reading.pose);
}

std::vector<std::string> namesOfViews(const DataSet& data) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < data.set.views.size(); ++i) names.push_back(data.set.views.header(i).name);
  return names;
}

py::array_t<double> posesOf(const DataSet& data) {
  const std::size_t size = data.set.views.size();
  py::array_t<double> poses({size, std::size_t{4}, std::size_t{4}});
  for (std::size_t i = 0; i < size; ++i)
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        poses.mutable_at(i, row, column) = data.set.views.header(i).world_from_camera.matrix()(row, column);
  return poses;
}

std::string shown(const DataSet& data) {
  return "<vdbfuse.DataSet: " + std::to_string(data.set.views.size()) + " views, " + data.set.format + ">";
}

}  // namespace

DataSetPointer makeDataSet(ViewSequence views, const char* format) {
  auto data = std::make_shared<DataSet>();
  data->pictures = [views] { return views; };
  data->set.views = std::move(views);
  data->set.format = format;
  return data;
}

void bindDataSet(py::module_& module) {
  py::class_<DataSet, DataSetPointer>(
      module, "DataSet",
      "Depth maps with their sensors and poses, loaded one at a time when they are needed. A sequence of "
      "View.")
      .def("__len__", [](const DataSet& self) { return self.set.views.size(); })
      .def("__getitem__", viewOf, "index"_a)
      .def("first", firstOf, "count"_a, "DataSet of the first `count` views.")
      .def_property_readonly("format", [](const DataSet& self) { return self.set.format; })
      .def_property_readonly(
          "notes", [](const DataSet& self) { return self.set.notes; },
          "list of str: what was left out or corrected.")
      .def_property_readonly("reading", readingOf, "dict: how the stored numbers are understood.")
      .def_property_readonly("names", namesOfViews)
      .def_property_readonly("world_from_camera", posesOf, "(N, 4, 4) float64.")
      .def_property_readonly(
          "report", [](const DataSet& self) { return self.report ? *self.report : py::none(); },
          "list of dict, one a view, of stereo(): partners, near, far, matching_error_px, noise_quadratic; "
          "None for other data sets.")
      .def("__repr__", shown);
  module.def("read", read, "path"_a, "progress"_a);
  module.def("write", write, "folder"_a, "data"_a, "format"_a, "depth_scale"_a, "progress"_a);
  module.def("convention_hint", conventionHint, "data"_a, "progress"_a);
  module.def("depth_option_names", [] { return namesOf(depthOptions()); });
  module.def("read_option_names", [] { return namesOf(readOptions()); });
  bindViewSource(module);
}

}  // namespace vdbfuse::python
