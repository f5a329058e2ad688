// SPDX-License-Identifier: Apache-2.0
// Arrays of numpy and the library's images and lists.
#pragma once

#include <cstdint>
#include <vector>

#include "python/binding.h"
#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse::python {

/// A read-only array whose numbers lie in `owner`, which lives as long as it: nothing is copied.
template <class T>
py::array readOnlyArray(const py::handle& owner, const std::vector<py::ssize_t>& shape, const T* data) {
  py::array_t<T> array(shape, data, owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// H×W, or None where the image is empty.
template <class T>
py::object arrayOf(const py::handle& owner, const Image<T>& image) {
  if (image.empty()) return py::none();
  return readOnlyArray(owner, {image.height(), image.width()}, image.data());
}
/// H×W×3.
py::object arrayOf(const py::handle& owner, const Image<Rgb8>& image);

/// Copies of arrays; empty for None. REQUIRES: H×W numbers of that type, or H×W×3 bytes.
Image<float> floatImage(const py::object& array);
Image<std::uint8_t> byteImage(const py::object& array);
Image<Rgb8> colorImage(const py::object& array);

/// Row-major 4×4.
py::array_t<double> matrixOf(const RigidTransform& transform);

}  // namespace vdbfuse::python
