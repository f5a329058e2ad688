// SPDX-License-Identifier: Apache-2.0
#include "python/arrays.h"

#include <cstring>

namespace vdbfuse::python {
namespace {

// T: a pixel, of numbers of type Number.
template <class T, class Number>
Image<T> copied(const py::object& object) {
  if (object.is_none()) return {};
  const py::array_t<Number, py::array::c_style> array(object);
  Image<T> image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
  std::memcpy(image.data(), array.data(), image.size() * sizeof(T));
  return image;
}

}  // namespace

py::object arrayOf(const py::handle& owner, const Image<Rgb8>& image) {
  if (image.empty()) return py::none();
  return readOnlyArray(owner, {image.height(), image.width(), 3}, image.data()->data());
}

Image<float> floatImage(const py::object& array) { return copied<float, float>(array); }
Image<std::uint8_t> byteImage(const py::object& array) { return copied<std::uint8_t, std::uint8_t>(array); }
Image<Rgb8> colorImage(const py::object& array) { return copied<Rgb8, std::uint8_t>(array); }

py::array_t<double> matrixOf(const RigidTransform& transform) {
  py::array_t<double> array({4, 4});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      array.mutable_at(row, column) = transform.matrix()(row, column);
  return array;
}

}  // namespace vdbfuse::python
