// SPDX-License-Identifier: Apache-2.0
// vdbfuse render MESH|GRID.vdb OUT.png: a picture of a mesh, or of a slice through a grid.
#include "vdbfuse/report/render.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>

#include "arguments.h"
#include "commands.h"
#include "render_slice.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/mesh/closest_point.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

struct Request {
  fs::path input, output, reference;
  std::string from, size = "800x600", color = "shaded", up = "z", slice, grid;
  std::vector<double> eye, look, range;
  bool flat = false, cells = false, overwrite = false;
  int threads = 0;
  int turntable = 0;
  int width = 0, height = 0;  // 0: that of the view of --from
};

Vector3d vector(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

std::size_t viewIndex(const ViewSequence& views, const std::string& name) {
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views.header(i).name == name) return i;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
  if (error == std::errc() && end == name.data() + name.size() && index < views.size()) return index;
  throw InvalidArgument("--from", "no view '" + name + "' among " + std::to_string(views.size()));
}

// DATASET:VIEW, where VIEW is a name or a number from 0.
ViewHeader viewOf(const Request& request) {
  const std::size_t colon = request.from.rfind(':');
  if (colon == std::string::npos)
    throw InvalidArgument("--from", "expected DATASET:VIEW, found '" + request.from + "'");
  const ViewSequence views = readDepthSet(request.from.substr(0, colon)).views;
  ViewHeader view = views.header(viewIndex(views, request.from.substr(colon + 1)));
  const int width = imageWidth(view.projection);
  if (request.width > 0)
    view.projection = scaled(view.projection, static_cast<double>(request.width) / width);
  return view;
}

ViewHeader camera(const Request& request, const TriangleMesh& mesh, const Vector3d& up) {
  if (!request.from.empty()) return viewOf(request);
  if (mesh.triangles.empty()) throw IoError(request.input, "", "a mesh", "no triangles");
  if (request.eye.empty()) return framingCamera(mesh, up, request.width, request.height);
  const Vector3d target = request.look.empty() ? Vector3d(boundingBox(mesh).center()) : vector(request.look);
  return cameraLookingAt(vector(request.eye), target, up, request.width, request.height);
}

RenderOptions renderOptions(const Request& request, const TriangleMesh& mesh) {
  RenderOptions options;
  options.up = axisNamed(request.up);
  if (request.color == "normal") options.coloring = MeshColoring::Normal;
  if (request.color == "support") options.coloring = MeshColoring::Support;
  if (request.color == "vertex") options.coloring = MeshColoring::Vertex;
  if (request.color == "error") {
    options.coloring = MeshColoring::Values;
    options.values = vertexDistances(mesh, ClosestPoint(readMesh(request.reference)));
  }
  if (request.flat) options.normals = RenderOptions::Normals::Flat;
  if (!request.range.empty()) options.low = request.range[0], options.high = request.range[1];
  return options;
}

SliceRequest sliceRequest(const Request& request) {
  if (request.slice.empty()) throw InvalidArgument("--slice", "is required to draw a grid, as --slice z=0");
  SliceRequest slice{request.input, request.slice, request.grid, std::max(request.width, request.height),
                     request.cells};
  if (!request.range.empty()) slice.low = request.range[0], slice.high = request.range[1];
  return slice;
}

void run(const Request& request) {
  const ThreadLimit limit(request.threads);
  if (fs::exists(request.output) && !request.overwrite)
    throw IoError(request.output, "", "no such file yet (or --overwrite)", "one");
  if (request.input.extension() == ".vdb") {
    writePng(request.output, renderSlice(sliceRequest(request)));
    return;
  }
  const TriangleMesh mesh = readMesh(request.input);
  const RenderOptions options = renderOptions(request, mesh);
  if (request.turntable > 0) {
    if (mesh.triangles.empty()) throw IoError(request.input, "", "a mesh", "no triangles");
    writePng(request.output,
             renderTurntable(mesh, request.turntable, request.width, request.height, options));
    return;
  }
  writePng(request.output, render(mesh, camera(request, mesh, options.up), options));
}

}  // namespace

void addRender(CLI::App& app, Action& action) {
  auto request = std::make_shared<Request>();
  CLI::App* command =
      app.add_subcommand("render",
                         "Draws a mesh, or a slice through a grid.\n"
                         "  vdbfuse render mesh.ply picture.png --from scan:0 --color support\n"
                         "  vdbfuse render grids.vdb slice.png --slice z=0 --grid sigma");
  command->add_option("mesh", request->input, "mesh to draw, or .vdb file")->required();
  command->add_option("png", request->output, "picture to write")->required();
  auto* from = command->add_option("--from", request->from, "from where a view of a data set was taken")
                   ->type_name("DATASET:VIEW");
  auto* eye =
      command->add_option("--eye", request->eye, "where the camera stands (default: it frames the mesh)")
          ->delimiter(',')
          ->expected(3)
          ->type_name("x,y,z")
          ->excludes(from);
  command
      ->add_option("--turntable", request->turntable,
                   "from so many sides around the axis that points up, in one picture; --size of each")
      ->check(CLI::Range(1, 400))
      ->excludes(from)
      ->excludes(eye);
  command->add_option("--look", request->look, "what it looks at (default: the middle)")
      ->delimiter(',')
      ->expected(3)
      ->type_name("x,y,z")
      ->needs(eye);
  command->add_option("--up", request->up, "axis that points up")->check(axisCheck())->capture_default_str();
  command
      ->add_option(
          "--color", request->color,
          "support: agreeing views, orange where invented; vertex: the mesh's own colours; error: distance "
          "from --reference")
      ->check(CLI::IsMember({"shaded", "normal", "support", "vertex", "error"}))
      ->capture_default_str();
  command->add_option("--reference", request->reference, "mesh that --color error measures from");
  command->add_option("--range", request->range, "values at the two ends of the colours")
      ->delimiter(',')
      ->expected(2)
      ->type_name("low,high");
  command->add_option("--slice", request->slice, "plane to draw of a .vdb file")->type_name("x|y|z=VALUE");
  command->add_flag("--cells", request->cells, "with --slice: lines between the cells of all levels");
  command->add_option("--grid", request->grid, "grid of the .vdb file (default: the first)");
  command->add_flag("--flat", request->flat, "show every triangle as it is");
  auto* size =
      command->add_option("--size", request->size, "of the picture, pixels (with --from: that of the view)")
          ->type_name("WxH")
          ->capture_default_str();
  command->add_option("--threads", request->threads, "0: all processors")->capture_default_str();
  command->add_flag("--overwrite", request->overwrite, "replace an existing picture");
  command->callback([request, size, &action] {
    if (request->color == "error" && request->reference.empty())
      throw CLI::RequiredError("--color error: --reference MESH");
    if (request->from.empty() || size->count() > 0)
      std::tie(request->width, request->height) = parseSize(request->size);
    action = [request] { run(*request); };
  });
}

}  // namespace vdbfuse::tool
