// SPDX-License-Identifier: Apache-2.0
// What vdbfuse.Scanner is made of.
#include "vdbfuse/pipeline/scanner.h"

#include <memory>
#include <vector>

#include "python/blocks.h"
#include "python/data_set.h"
#include "python/fuse.h"
#include "python/long_call.h"
#include "python/module.h"
#include "python/preview_options.h"
#include "python/views.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::python {
namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;
using O = ScannerOptions;
using V = OptionValue;

std::vector<Option<ScannerOptions>> scannerOptions() {
  std::vector<Option<O>> options = previewOptions();
  options.insert(options.end(), {{"min_depth", [](O& o, const V& v) { o.near = v.number(); }},
                                 {"max_depth", [](O& o, const V& v) { o.far = v.positive(); }},
                                 {"queue", [](O& o, const V& v) { o.queue_capacity = v.count(); }},
                                 {"when_full",
                                  [](O& o, const V& v) {
                                    o.when_full = v.choice<WhenFull>({{"drop-oldest", WhenFull::DropOldest},
                                                                      {"drop-newest", WhenFull::DropNewest},
                                                                      {"wait", WhenFull::Wait}});
                                  }},
                                 {"memory", [](O& o, const V& v) { o.memory = v.count(); }}});
  return options;
}

std::unique_ptr<Scanner> makeScanner(const py::kwargs& keywords) {
  ScannerOptions options;
  applyOptions("Scanner", scannerOptions(), keywords, options);
  return std::make_unique<Scanner>(options);
}

// poses: (N, 4, 4).
void correctPoses(Scanner& self, const std::vector<ViewId>& views, const py::array_t<double>& poses,
                  bool is_camera_from_world, bool has_opengl_axes) {
  std::vector<PoseCorrection> corrections;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const py::array_t<double> pose(poses[py::int_(i)]);
    corrections.push_back({views[i], poseOf("poses[" + std::to_string(i) + "]", pose,
                                            {is_camera_from_world, has_opengl_axes})});
  }
  const py::gil_scoped_release unlocked;
  self.correctPoses(corrections);
}

py::tuple previewNow(Scanner& self) {
  ScannerPreview preview;
  {
    const py::gil_scoped_release unlocked;
    preview = self.preview();
  }
  py::list removed;
  for (const Index3& origin : preview.removed) removed.append(tupleOf(origin));
  return py::make_tuple(listOf(std::move(preview.changed)), removed, preview.newest);
}

std::shared_ptr<Mesh> meshNow(Scanner& self) {
  TriangleMesh mesh;
  {
    const py::gil_scoped_release unlocked;
    mesh = self.mesh();
  }
  return makeMesh(std::move(mesh));
}

py::dict statusOf(const Scanner& self) {
  const ScannerStatus s = self.status();
  return py::dict("pushed"_a = s.pushed, "integrated"_a = s.integrated, "dropped"_a = s.dropped,
                  "waiting"_a = s.waiting, "corrections"_a = s.corrections, "kept"_a = s.kept,
                  "kept_bytes"_a = s.kept_bytes, "preview_bytes"_a = s.preview_bytes);
}

std::shared_ptr<Mesh> finish(Scanner& self, double key_distance, double key_angle, const py::object& progress,
                             const py::kwargs& keywords) {
  FuseRequest request;
  applyOptions("finish", fuseOptions(), keywords, request);
  FinishOptions options{request.options, {key_distance, key_angle}, FinishOptions::Colors::Drop};
  return meshOf(longCall(progress, [&](const Progress& inner) {
    const ThreadLimit threads(request.threads);
    self.wait(inner);
    const ViewSequence views = self.views(options.key_views);
    const bool has_pictures = !views.empty() && !views.load(0).map.color.empty();
    if (request.has_colors && has_pictures) options.colors = FinishOptions::Colors::Keep;
    return self.finish(options, inner);
  }));
}

}  // namespace

void bindScanner(py::module_& module) {
  py::class_<Scanner>(module, "Scanner")
      .def(py::init(&makeScanner))
      .def("push", &Scanner::push, "view"_a, Unlocked())
      .def("remove", &Scanner::remove, "view"_a, Unlocked())
      .def("correct_poses", correctPoses, "views"_a, "poses"_a, "is_camera_from_world"_a, "has_opengl_axes"_a)
      .def(
          "wait",
          [](Scanner& self, const py::object& progress) {
            runLong(progress, [&](const Progress& inner) { self.wait(inner); });
          },
          "progress"_a)
      .def("preview", previewNow)
      .def("mesh", meshNow)
      .def("status", statusOf)
      .def(
          "views",
          [](const Scanner& self, double distance, double angle) {
            return makeDataSet(self.views({distance, angle}), "scanner");
          },
          "distance"_a, "angle"_a)
      .def("finish", finish, "key_distance"_a, "key_angle"_a, "progress"_a);
  module.def("scanner_option_names", [] { return namesOf(scannerOptions()); });
}

}  // namespace vdbfuse::python
