// SPDX-License-Identifier: Apache-2.0
// What vdbfuse.TSDF is made of.
#include <filesystem>
#include <memory>
#include <vector>

#include "python/blocks.h"
#include "python/module.h"
#include "python/preview_options.h"
#include "vdbfuse/pipeline/integrator.h"

namespace vdbfuse::python {
namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;

std::vector<Option<ScannerOptions>> tsdfOptions() {
  std::vector<Option<ScannerOptions>> options = previewOptions();
  options.push_back({"carve", [](ScannerOptions& o, const OptionValue& v) {
                       if (v.flag()) o.preview.carving = IntegratorOptions::Carving::On;
                     }});
  return options;
}

IntegratorOptions optionsOf(const py::kwargs& keywords) {
  ScannerOptions options;
  applyOptions("TSDF", tsdfOptions(), keywords, options);
  return options.preview;
}

std::unique_ptr<Integrator> load(const std::filesystem::path& path, const py::kwargs& keywords) {
  const IntegratorOptions options = optionsOf(keywords);
  const py::gil_scoped_release unlocked;
  return std::make_unique<Integrator>(TsdfVolume::read(path), options);
}

py::dict dictOf(const TsdfReport& report) {
  return py::dict("leaves"_a = report.leaves, "created"_a = report.created, "voxels"_a = report.voxels,
                  "before"_a = report.before);
}

using Step = TsdfReport (Integrator::*)(const View&);

template <Step step>
py::dict workIn(Integrator& self, const View& view) {
  TsdfReport report;
  {
    const py::gil_scoped_release unlocked;
    report = (self.*step)(view);
  }
  return dictOf(report);
}

std::shared_ptr<Mesh> meshNow(Integrator& self) {
  TriangleMesh mesh;
  {
    const py::gil_scoped_release unlocked;
    mesh = self.mesh();
  }
  return makeMesh(std::move(mesh));
}

py::list changes(Integrator& self) {
  std::vector<SurfaceBlock> blocks;
  {
    const py::gil_scoped_release unlocked;
    blocks = self.changedBlocks();
  }
  return listOf(std::move(blocks));
}

}  // namespace

void bindTsdf(py::module_& module) {
  py::class_<Integrator>(module, "Integrator")
      .def(py::init(
          [](const py::kwargs& keywords) { return std::make_unique<Integrator>(optionsOf(keywords)); }))
      .def_static("load", load, "path"_a)
      .def("integrate", workIn<&Integrator::integrate>, "view"_a)
      .def("remove", workIn<&Integrator::remove>, "view"_a)
      .def("mesh", meshNow)
      .def("changed_blocks", changes)
      .def("save", &Integrator::write, "path"_a, Unlocked())
      .def_property_readonly("memory_bytes", &Integrator::memoryBytes)
      .def_property_readonly("leaves", &Integrator::leafCount);
  module.def("tsdf_option_names", [] { return namesOf(tsdfOptions()); });
}

}  // namespace vdbfuse::python
