// SPDX-License-Identifier: Apache-2.0
// Where the views of arrays come from: asked for one by one, or taken once and kept.
#pragma once

#include "python/binding.h"

namespace vdbfuse::python {

/// on_demand(): a DataSet that calls load(index, with_color) for the arrays whenever a view is needed, and
/// keeps none. ViewStore: takes views that come once (a generator's) and keeps them small, in memory up to a
/// limit, then in a file without a name.
void bindViewSource(py::module_& module);

}  // namespace vdbfuse::python
