// SPDX-License-Identifier: Apache-2.0
// What a reconstruction found out and did, as a dict: the members of the JSON file of vdbfuse fuse.
#pragma once

#include <vector>

#include "python/binding.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace vdbfuse::python {

py::dict reportOf(const Reconstruction& result);
py::list stepsOf(const std::vector<StepTime>& steps);

}  // namespace vdbfuse::python
