// SPDX-License-Identifier: Apache-2.0
// The parts of the extension module, a file each, in the order in which they are bound: what is a type of
// another one's signature comes first.
#pragma once

#include "python/binding.h"

namespace vdbfuse::python {

/// InvalidArgument: ValueError; IoError: OSError; Cancelled: KeyboardInterrupt; every other Error:
/// RuntimeError. The messages stay.
void bindErrors();
void bindMesh(py::module_& module);
void bindViews(py::module_& module);
void bindDataSet(py::module_& module);
void bindFuse(py::module_& module);
void bindJudge(py::module_& module);
void bindStereo(py::module_& module);
void bindEvaluate(py::module_& module);
void bindTsdf(py::module_& module);
void bindScanner(py::module_& module);

}  // namespace vdbfuse::python
