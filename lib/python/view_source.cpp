// SPDX-License-Identifier: Apache-2.0
#include "python/view_source.h"

#include <string>
#include <utility>
#include <vector>

#include "pipeline/kept_views.h"
#include "python/data_set.h"
#include "python/views.h"

namespace vdbfuse::python {
namespace {

std::vector<ViewHeader> headersOf(const std::vector<std::string>& names,
                                  const std::vector<std::pair<int, int>>& shapes,
                                  const py::array_t<double>& cameras, const py::array_t<double>& poses,
                                  const PoseReading& reading) {
  std::vector<ViewHeader> headers(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const py::array_t<double> camera(cameras[py::int_(i)]), pose(poses[py::int_(i)]);
    headers[i].name = names[i];
    headers[i].world_from_camera = poseOf("poses[" + std::to_string(i) + "]", pose, reading);
    headers[i].projection = pinholeOf(camera, shapes[i].second, shapes[i].first);
  }
  return headers;
}

ViewSequence::Loader loaderOf(const std::vector<ViewHeader>& headers, const Held& load,
                              ReadOptions::Color color, const ReadRequest& options) {
  std::vector<Projection> projections;
  for (const ViewHeader& header : headers) projections.push_back(header.projection);
  return [=, with_color = color == ReadOptions::Color::Load](std::size_t index) {
    const py::gil_scoped_acquire lock;
    const ViewArrays arrays = viewArrays((*load)(index, with_color));
    return depthMap(arrays, projections[index], options);
  };
}

DataSetPointer onDemand(const py::object& load, const std::vector<std::string>& names,
                        const std::vector<std::pair<int, int>>& shapes, const py::array_t<double>& cameras,
                        const py::array_t<double>& poses, bool is_camera_from_world, bool has_opengl_axes,
                        const ReadRequest& options) {
  const PoseReading reading{is_camera_from_world, has_opengl_axes};
  const std::vector<ViewHeader> headers = headersOf(names, shapes, cameras, poses, reading);
  const Held held = hold(load);
  const ViewSequence pictures(headers, loaderOf(headers, held, ReadOptions::Color::Load, options));
  DataSetPointer data = makeDataSet(
      ViewSequence(headers, loaderOf(headers, held, ReadOptions::Color::Skip, options)), "arrays");
  data->pictures = [pictures] { return pictures; };
  data->set.stored_from_camera.assign(headers.size(), storedFromCamera(reading));
  return data;
}

class ViewStore {
 public:
  explicit ViewStore(std::size_t memory) : views_(memory) {}

  void add(const View& view) {
    views_.insert(++last_, {view, std::make_shared<const PackedImages>(view.map, views_.nextMemory())});
  }
  DataSetPointer dataSet(bool has_opengl_axes) const {
    DataSetPointer data = makeDataSet(views_.sequence({}), "arrays");
    data->set.stored_from_camera.assign(views_.size(), storedFromCamera({false, has_opengl_axes}));
    return data;
  }

 private:
  KeptViews views_;
  ViewId last_ = 0;
};

}  // namespace

void bindViewSource(py::module_& module) {
  module.def("on_demand", onDemand, "load"_a, "names"_a, "shapes"_a, "cameras"_a, "poses"_a,
             "is_camera_from_world"_a, "has_opengl_axes"_a, "reading"_a);
  py::class_<ViewStore>(module, "ViewStore")
      .def(py::init<std::size_t>(), "memory"_a)
      .def("add", &ViewStore::add, "view"_a, py::call_guard<py::gil_scoped_release>())
      .def("data_set", &ViewStore::dataSet, "has_opengl_axes"_a);
}

}  // namespace vdbfuse::python
