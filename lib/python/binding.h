// SPDX-License-Identifier: Apache-2.0
// What all bindings share.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <utility>

namespace vdbfuse::python {

namespace py = pybind11;
using namespace pybind11::literals;

/// A Python object that may be let go of on any thread.
using Held = std::shared_ptr<const py::object>;
/// REQUIRES: the interpreter's lock is held.
inline Held hold(py::object object) {
  return {new py::object(std::move(object)), [](const py::object* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

}  // namespace vdbfuse::python
