// SPDX-License-Identifier: Apache-2.0
// vdbfuse render MESH|GRID.vdb OUT.png: a picture of a mesh, or of a slice through a grid.
#include "vdbfuse/report/render.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>

#include "arguments.h"
#include "cli/number_check.h"
#include "cli/one_of.h"
#include "commands.h"
#include "interrupts.h"
#include "render_slice.h"
#include "run_options.h"
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

struct Request : RunArguments {
  fs::path input, output, reference;
  std::string from, size = "800x600", color = "shaded", up = "z", slice, grid;
  std::vector<double> eye, look, range;
  bool flat = false, cells = false;
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

Image<Rgb8> draw(const Request& request) {
  if (request.input.extension() == ".vdb") return renderSlice(sliceRequest(request));
  const TriangleMesh mesh = readMesh(request.input);
  stopIfInterrupted();
  const RenderOptions options = renderOptions(request, mesh);
  if (request.turntable == 0) return render(mesh, camera(request, mesh, options.up), options);
  if (mesh.triangles.empty()) throw IoError(request.input, "", "a mesh", "no triangles");
  return renderTurntable(mesh, request.turntable, request.width, request.height, options);
}

Json jsonOf(const Request& request, const Image<Rgb8>& picture) {
  Json json = tool::jsonOf("render");
  json["options"] = {{"input", request.input.string()}, {"color", request.color}, {"up", request.up}};
  json["picture"] = {
      {"path", request.output.string()}, {"width", picture.width()}, {"height", picture.height()}};
  return json;
}

void run(const Request& request) {
  const ThreadLimit limit(request.threads);
  if (fs::exists(request.output) && !request.overwrite)
    throw IoError(request.output, "", "no such file yet (or --overwrite)", "one");
  refuseExistingJson(request);
  const Image<Rgb8> picture = draw(request);
  JsonReport json(request, jsonOf(request, picture));
  stopIfInterrupted();
  writePng(request.output, picture);
  json.commit();
}

void addCameraOptions(CLI::App& app, Request& request) {
  app.option_defaults()->group("Camera");
  auto* from = app.add_option("--from", request.from, "From where a view of a data set was taken")
                   ->type_name("DATASET:VIEW")
                   ->option_text("none: the mesh fills the picture");
  auto* eye = app.add_option("--eye", request.eye, "Where the camera stands")
                  ->delimiter(',')
                  ->expected(3)
                  ->type_name("x,y,z")
                  ->option_text("where the mesh fills the picture")
                  ->excludes(from);
  app.add_option("--look", request.look, "What it looks at")
      ->delimiter(',')
      ->expected(3)
      ->type_name("x,y,z")
      ->option_text("the middle of the mesh")
      ->needs(eye);
  app.add_option(
         "--turntable", request.turntable,
         "From so many sides around the axis that points up, in one picture; --size of each; 0: from one")
      ->check(numberBetween(0, 400))
      ->type_name("N")
      ->capture_default_str()
      ->excludes(from)
      ->excludes(eye);
  app.add_option("--up", request.up, "Axis that points up")
      ->transform(axisCheck())
      ->type_name("WORD")
      ->capture_default_str();
}

void addColorOptions(CLI::App& app, Request& request) {
  app.option_defaults()->group("Colours");
  app.add_option(
         "--color", request.color,
         "support: agreeing views, orange where invented; vertex: the mesh's own colours; error: distance "
         "from --reference")
      ->transform(oneOf({"shaded", "normal", "support", "vertex", "error"}))
      ->type_name("WORD")
      ->capture_default_str();
  app.add_option("--reference", request.reference, "Mesh that --color error measures from")
      ->type_name("FILE")
      ->option_text("none");
  app.add_option("--range", request.range, "Values at the two ends of the colours")
      ->delimiter(',')
      ->expected(2)
      ->type_name("low,high")
      ->option_text("from the data");
  app.add_flag("--flat", request.flat, "Show every triangle as it is");
}

void addSliceOptions(CLI::App& app, Request& request) {
  app.option_defaults()->group("Slices of .vdb files");
  app.add_option("--slice", request.slice, "Plane to draw")->type_name("x|y|z=VALUE")->option_text("none");
  app.add_option("--grid", request.grid, "Grid of the file")->type_name("NAME")->option_text("the first");
  app.add_flag("--cells", request.cells, "With lines between the cells of all levels");
}

}  // namespace

void addRender(CLI::App& app, Action& action) {
  auto request = std::make_shared<Request>();
  CLI::App& sub = *app.add_subcommand("render", "Draw a mesh, or a slice through a grid");
  sub.footer(
      "vdbfuse render mesh.ply picture.png --from scan/:0 --color support\n"
      "vdbfuse render mesh.ply all.png --turntable 8\n"
      "vdbfuse render grids.vdb slice.png --slice z=0 --grid sigma");
  sub.add_option("MESH,--input", request->input, "Mesh to draw, or .vdb file")->type_name("FILE")->required();
  sub.add_option("PNG,--output", request->output, "Picture to write")->type_name("FILE")->required();
  addCameraOptions(sub, *request);
  addColorOptions(sub, *request);
  addSliceOptions(sub, *request);
  sub.option_defaults()->group("Output");
  auto* size =
      sub.add_option("--size", request->size, "Of the picture; with --from: that of the view, unless given")
          ->type_name("WxH")
          ->capture_default_str();
  addJsonOption(sub, request->json, "Write what was drawn as one JSON object");
  addRunOptions(sub, *request);
  sub.callback([request, size, &action] {
    if (request->color == "error" && request->reference.empty())
      throw CLI::RequiredError("--color error: --reference MESH");
    if (request->from.empty() || size->count() > 0)
      std::tie(request->width, request->height) = parseSize(request->size);
    action = [request] { run(*request); };
  });
}

}  // namespace vdbfuse::tool
