// SPDX-License-Identifier: Apache-2.0
// The extension module vdbfuse._core. What its functions take is checked and brought into one form by the
// modules written in Python beside it; they, not these, are for users.
#include "python/module.h"

#include "vdbfuse/base/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace vdbfuse::python;  // NOLINT: the one place that binds everything
  module.attr("version") = vdbfuse::version();
  bindErrors();
  bindMesh(module);
  bindViews(module);
  bindDataSet(module);
  bindFuse(module);
  bindJudge(module);
  bindStereo(module);
  bindEvaluate(module);
  bindTsdf(module);
  bindScanner(module);
}
