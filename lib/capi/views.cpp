// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>

#include "capi/handles.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/sensor/depth_buffer.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse::capi {
namespace {

// Bytes of the structs in version 1 of the interface.
constexpr std::size_t kViewBytes = offsetof(vdbfuse_view, color_height) + sizeof(std::int32_t),
                      kSynthBytes = offsetof(vdbfuse_synth_options, seed) + sizeof(std::uint64_t);

vdbfuse_view defaultView() {
  vdbfuse_view view{};
  view.struct_size = sizeof view;
  view.depth_scale = 1;
  for (int i = 0; i < 4; ++i) view.world_from_camera[5 * i] = 1;
  return view;
}

vdbfuse_synth_options defaultSynth() {
  const SynthOptions from;
  vdbfuse_synth_options options{};
  options.struct_size = sizeof options;
  options.views = from.views, options.width = from.width, options.height = from.height;
  options.arc = VDBFUSE_ARC_FULL;
  options.noise_scale = from.noise_scale, options.outliers = from.outliers, options.seed = from.seed;
  options.cell = SceneOptions().cell;
  return options;
}

Arc arcOf(std::int32_t arc) {
  return choice(arc, {Arc::Full, Arc::Ring, Arc::Upper, Arc::Front, Arc::Room}, "options.arc");
}

Pinhole cameraOf(const vdbfuse_view& view) {
  Pinhole camera{view.width, view.height, view.fx, view.fy, view.cx, view.cy, {}};
  std::copy(std::begin(view.distortion), std::end(view.distortion), camera.distortion.begin());
  const std::vector<std::string> problems = validate(Projection(camera));
  if (!problems.empty()) throw InvalidArgument("view", problems.front());
  return camera;
}

template <class T>
Image<T> copied(const T* pixels, int width, int height) {
  Image<T> image(width, height);
  std::copy(pixels, pixels + image.size(), image.data());
  return image;
}

Image<Rgb8> colorOf(const vdbfuse_view& view) {
  if (view.color_width <= 0 || view.color_height <= 0)
    throw InvalidArgument("view.color", "its width and height must be positive");
  Image<Rgb8> image(view.color_width, view.color_height);
  std::memcpy(image.data(), view.color, 3 * image.size());
  return image;
}

DepthMap depthMapOf(const vdbfuse_view& view, const Projection& projection) {
  requireNotNull(view.depth, "view.depth");
  DepthBuffer buffer;
  buffer.data = view.depth;
  buffer.type =
      choice(view.depth_type, {DepthBuffer::Type::Float32, DepthBuffer::Type::UInt16}, "view.depth_type");
  buffer.width = view.width, buffer.height = view.height;
  buffer.row_stride = static_cast<std::ptrdiff_t>(view.depth_row_bytes);
  buffer.encoding.kind =
      choice(view.depth_kind, {DepthKind::Z, DepthKind::Range, DepthKind::Disparity, DepthKind::Inverse},
             "view.depth_kind");
  buffer.encoding.scale = view.depth_scale;
  buffer.encoding.focal_baseline = view.depth_focal_baseline;
  DepthMap map = importDepth(buffer, projection);
  if (view.confidence != nullptr) map.confidence = copied(view.confidence, view.width, view.height);
  if (view.mask != nullptr) map.mask = copied(view.mask, view.width, view.height);
  if (view.color != nullptr) map.color = colorOf(view);
  return map;
}

template <class T>
const T* dataOf(const Image<T>& image) {
  return image.empty() ? nullptr : image.data();
}

vdbfuse_view lend(const View& view) {
  const Pinhole* camera = std::get_if<Pinhole>(&view.projection);
  if (camera == nullptr)
    throw InvalidArgument("index", "view '" + view.name + "' is not of a pinhole camera");
  vdbfuse_view out = defaultView();
  out.name = view.name.c_str();
  out.width = camera->width, out.height = camera->height;
  out.fx = camera->fx, out.fy = camera->fy, out.cx = camera->cx, out.cy = camera->cy;
  std::copy(camera->distortion.begin(), camera->distortion.end(), out.distortion);
  for (int i = 0; i < 16; ++i) out.world_from_camera[i] = view.world_from_camera.matrix()(i / 4, i % 4);
  out.depth = view.map.depth.data();
  out.confidence = dataOf(view.map.confidence), out.mask = dataOf(view.map.mask);
  if (!view.map.color.empty() && !view.color_sensor) {
    out.color = view.map.color.data()->data();
    out.color_width = view.map.color.width(), out.color_height = view.map.color.height();
  }
  return out;
}

vdbfuse_views* handleOf(const ViewSequence& sequence) {
  auto views = std::make_unique<vdbfuse_views>();
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    views->headers.push_back(sequence.header(i));
    views->loaders.emplace_back([sequence, i] { return sequence.load(i).map; });
  }
  return views.release();
}

}  // namespace

RigidTransform poseOf(const double* world_from_camera) {
  requireNotNull(world_from_camera, "world_from_camera");
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(world_from_camera);
  if (!matrix.allFinite() || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw InvalidArgument("world_from_camera", "expected finite numbers, the last four of them 0 0 0 1");
  return rigidFromMatrix(matrix);
}

View viewOf(const vdbfuse_view* given) {
  const vdbfuse_view from = readStruct(given, defaultView(), kViewBytes, "view");
  View view;
  view.name = from.name != nullptr ? from.name : "";
  view.projection = cameraOf(from);
  view.world_from_camera = poseOf(from.world_from_camera);
  view.map = depthMapOf(from, view.projection);
  return view;
}

}  // namespace vdbfuse::capi

using namespace vdbfuse;
using namespace vdbfuse::capi;

ViewSequence vdbfuse_views::sequence() const {
  return {headers, [copies = loaders](std::size_t index) { return copies[index](); }};
}

vdbfuse_status vdbfuse_view_init(vdbfuse_view* view, uint64_t struct_size) {
  return guarded([&] { writeStruct(defaultView(), struct_size, kViewBytes, "view", view); });
}

vdbfuse_status vdbfuse_synth_options_init(vdbfuse_synth_options* options, uint64_t struct_size) {
  return guarded([&] { writeStruct(defaultSynth(), struct_size, kSynthBytes, "options", options); });
}

vdbfuse_status vdbfuse_views_create(vdbfuse_views** out) {
  return guardedHandle(out, [] { return new vdbfuse_views; });
}

vdbfuse_status vdbfuse_views_read(const char* path, vdbfuse_views** out) {
  return guardedHandle(out, [&] {
    requireNotNull(path, "path");
    return handleOf(readDepthSet(path).views);
  });
}

vdbfuse_status vdbfuse_views_synthesize(const char* scene, const vdbfuse_synth_options* options,
                                        vdbfuse_views** out) {
  return guardedHandle(out, [&] {
    requireNotNull(scene, "scene");
    const vdbfuse_synth_options from =
        options == nullptr ? defaultSynth() : readStruct(options, defaultSynth(), kSynthBytes, "options");
    SynthOptions synth;
    synth.views = from.views, synth.width = from.width, synth.height = from.height;
    synth.arc = arcOf(from.arc);
    synth.noise_scale = from.noise_scale, synth.outliers = from.outliers, synth.seed = from.seed;
    return handleOf(SyntheticScan(makeScene(scene, {from.cell}), synth).views());
  });
}

vdbfuse_status vdbfuse_views_add(vdbfuse_views* views, const vdbfuse_view* view) {
  return guarded([&] {
    requireNotNull(views, "views");
    View added = viewOf(view);
    if (added.name.empty()) added.name = "view " + std::to_string(views->headers.size());
    const ViewHeader header = added;
    views->loaders.emplace_back(
        [map = std::make_shared<const DepthMap>(std::move(added.map))] { return *map; });
    views->headers.push_back(header);
  });
}

size_t vdbfuse_views_count(const vdbfuse_views* views) {
  return views == nullptr ? 0 : views->headers.size();
}

vdbfuse_status vdbfuse_views_get(vdbfuse_views* views, size_t index, vdbfuse_view* out) {
  return guarded([&] {
    requireNotNull(views, "views");
    requireNotNull(out, "out");
    if (index >= views->headers.size())
      throw InvalidArgument("index",
                            "is " + std::to_string(index) + " of " + std::to_string(views->headers.size()));
    auto place = views->lent.find(index);
    if (place == views->lent.end()) place = views->lent.emplace(index, views->sequence().load(index)).first;
    writeStruct(lend(place->second), out->struct_size, kViewBytes, "out", out);
  });
}

void vdbfuse_views_destroy(vdbfuse_views* views) { delete views; }
