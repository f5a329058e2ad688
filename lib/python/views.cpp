// SPDX-License-Identifier: Apache-2.0
#include "python/views.h"

#include <cstring>
#include <limits>

#include "formats/stored_depth.h"
#include "python/module.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse::python {
namespace {

constexpr double kUnitOfWholeNumbers = 0.001;  // as in arrays on disk (formats/numpy.h)

bool isWhole(const py::array& depth) { return depth.itemsize() == sizeof(std::uint16_t); }

Image<float> storedImage(const py::array& depth) {
  Image<float> image(static_cast<int>(depth.shape(1)), static_cast<int>(depth.shape(0)));
  const auto* row = static_cast<const std::byte*>(depth.data());
  for (int y = 0; y < image.height(); ++y, row += depth.strides(0)) {
    if (!isWhole(depth)) {
      std::memcpy(image.row(y), row, sizeof(float) * static_cast<std::size_t>(image.width()));
      continue;
    }
    for (int x = 0; x < image.width(); ++x) {
      std::uint16_t value;
      std::memcpy(&value, row + sizeof value * static_cast<std::size_t>(x), sizeof value);
      image(x, y) = value == std::numeric_limits<std::uint16_t>::max() ? 0.0f : static_cast<float>(value);
    }
  }
  return image;
}

using ViewPointer = std::shared_ptr<View>;

ViewPointer makeView(const std::string& name, const py::tuple& arrays, const py::array_t<double>& camera,
                     const py::array_t<double>& pose, bool is_camera_from_world, bool has_opengl_axes,
                     const ReadRequest& options) {
  const ViewArrays images = viewArrays(arrays);
  auto view = std::make_shared<View>();
  view->name = name;
  view->world_from_camera = poseOf(name, pose, {is_camera_from_world, has_opengl_axes});
  view->projection =
      pinholeOf(camera, static_cast<int>(images.depth.shape(1)), static_cast<int>(images.depth.shape(0)));
  if (const auto problems = validate(view->projection); !problems.empty())
    throw InvalidArgument(name, problems.front());
  view->map = depthMap(images, view->projection, options);
  if (const auto problems = validate(*view); !problems.empty()) throw InvalidArgument(name, problems.front());
  applyMask(view->map);
  return view;
}

py::object intrinsicsOf(const View& view) {
  const auto* camera = std::get_if<Pinhole>(&view.projection);
  if (camera == nullptr) return py::none();
  const Eigen::Matrix3d k = intrinsicMatrix(*camera);
  py::array_t<double> matrix({3, 3});
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) matrix.mutable_at(row, column) = k(row, column);
  return matrix;
}

py::object distortionOf(const View& view) {
  const auto* camera = std::get_if<Pinhole>(&view.projection);
  if (camera == nullptr) return py::none();
  return py::array_t<double>(camera->distortion.size(), camera->distortion.data());
}

std::string projectionName(const View& view) {
  constexpr const char* kNames[] = {"pinhole", "spherical", "orthographic", "push-broom"};
  return kNames[view.projection.index()];
}

py::object imageOf(const py::object& self, const auto& image) { return arrayOf(self, image); }

std::string shown(const View& view) {
  return "<vdbfuse.View '" + view.name + "': " + std::to_string(view.map.depth.width()) + "x" +
         std::to_string(view.map.depth.height()) + " pixels, " + projectionName(view) + ">";
}

void bindImages(py::class_<View, ViewPointer>& view) {
  const auto map = [](const py::object& self) -> const DepthMap& { return self.cast<const View&>().map; };
  view.def_property_readonly(
          "depth", [=](const py::object& self) { return imageOf(self, map(self).depth); },
          "(H, W) float32, unit of the poses: z for pinholes, range for spherical sensors; 0: nothing "
          "measured.")
      .def_property_readonly(
          "confidence", [=](const py::object& self) { return imageOf(self, map(self).confidence); },
          "(H, W) float32 of any scale and direction, or None.")
      .def_property_readonly(
          "color", [=](const py::object& self) { return imageOf(self, map(self).color); },
          "(H', W', 3) uint8: red, green, blue; or None.")
      .def_property_readonly(
          "mask", [=](const py::object& self) { return imageOf(self, map(self).mask); },
          "(H, W) uint8, 0 where the pixel looks past the object; or None.");
}

}  // namespace

RigidTransform storedFromCamera(const PoseReading& reading) {
  RigidTransform transform = RigidTransform::Identity();
  if (reading.has_opengl_axes) transform.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return transform;
}

RigidTransform poseOf(const std::string& where, const py::array_t<double>& matrix,
                      const PoseReading& reading) {
  Eigen::Matrix4d numbers;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) numbers(row, column) = matrix.at(row, column);
  try {
    const RigidTransform pose = rigidFromMatrix(numbers);
    return (reading.is_camera_from_world ? pose.inverse() : pose) * storedFromCamera(reading);
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(where, error.what());
  }
}

Pinhole pinholeOf(const py::array_t<double>& numbers, int width, int height) {
  const double* n = numbers.data();
  return {width, height, n[0], n[1], n[2], n[3], {n[4], n[5], n[6], n[7], n[8]}};
}

ViewArrays viewArrays(const py::tuple& arrays) { return {arrays[0], arrays[1], arrays[2], arrays[3]}; }

DepthMap depthMap(const ViewArrays& arrays, const Projection& projection, const ReadOptions& options) {
  DepthMap map;
  map.confidence = floatImage(arrays.confidence);
  map.color = colorImage(arrays.color);
  map.mask = byteImage(arrays.mask);
  const double unit = isWhole(arrays.depth) ? kUnitOfWholeNumbers : 1.0;
  const py::gil_scoped_release unlocked;
  map.depth = sensorDepth(storedImage(arrays.depth), projection,
                          encodingFor(options, projection, DepthKind::Z, unit), options);
  return map;
}

void bindViews(py::module_& module) {
  py::class_<ReadRequest>(module, "Reading").def(py::init([](const py::kwargs& keywords) {
    ReadRequest request;
    applyOptions("view", depthOptions(), keywords, request);
    return request;
  }));
  py::class_<View, ViewPointer> view(
      module, "View",
      "A depth map with its sensor and pose. Arrays are read-only views of its memory. Camera axes: x right, "
      "y down, z forward; pixel centres at integers.");
  bindImages(view);
  view.def_property_readonly("name", [](const View& self) { return self.name; })
      .def_property_readonly(
          "shape",
          [](const View& self) { return py::make_tuple(self.map.depth.height(), self.map.depth.width()); },
          "(H, W).")
      .def_property_readonly("projection", projectionName, "pinhole, spherical, orthographic or push-broom.")
      .def_property_readonly("intrinsics", intrinsicsOf, "(3, 3) float64, pixels; None for other sensors.")
      .def_property_readonly("distortion", distortionOf,
                             "(5,) float64: k1, k2, p1, p2, k3 of Brown and Conrady; None for other sensors.")
      .def_property_readonly(
          "world_from_camera", [](const View& self) { return matrixOf(self.world_from_camera); },
          "(4, 4) float64: takes points of the camera to points of the world.")
      .def_property_readonly(
          "camera_from_world", [](const View& self) { return matrixOf(self.world_from_camera.inverse()); },
          "(4, 4) float64: the inverse.")
      .def("__repr__", shown);
  module.def("make_view", makeView, "name"_a, "arrays"_a, "camera"_a, "pose"_a, "is_camera_from_world"_a,
             "has_opengl_axes"_a, "reading"_a);
}

}  // namespace vdbfuse::python
