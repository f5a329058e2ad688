// SPDX-License-Identifier: Apache-2.0
#include "formats/numpy.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "formats/camera_text.h"
#include "formats/numpy_arrays.h"
#include "formats/numpy_layout.h"
#include "formats/stored_depth.h"
#include "io/folder.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
// Compressed, a small file can promise more frames than memory holds.
constexpr std::size_t kMostFrames = 1000000;

// One frame.
struct NumpyFrame {
  ArrayItem depth;
  std::optional<ArrayItem> confidence, color;
  fs::path picture;
};

struct NumpySource {
  std::vector<NumpyFrame> frames;
  std::vector<ViewHeader> headers;
  ReadOptions options;
};

// The item of a frame: in its own files, else in those of all.
std::optional<ArrayItem> findItem(const ArrayGroup& own, const ArrayGroup& shared, ArrayRole role,
                                  std::size_t index, std::size_t count) {
  if (auto array = own.find(role)) return itemOf(std::move(array), role, 0, 1);
  if (auto array = shared.find(role)) return itemOf(std::move(array), role, index, count);
  return std::nullopt;
}

Eigen::MatrixXd readMatrixItem(const ArrayItem& item, int least_rows, int columns) {
  const fs::path& path = item.array->path();
  const std::int64_t rows = item.shape[0];
  if ((rows != least_rows && rows != columns) || item.shape[1] != columns)
    throw IoError(path, item.array->place(),
                  sizeText(least_rows, columns) + (least_rows < columns ? " or 4x4" : "") + " matrices",
                  "shape " + item.array->header().shapeText());
  const io::NpyArray numbers = item.read();
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    const double value = numbers[static_cast<std::size_t>(i)];
    if (!std::isfinite(value))
      throw IoError(path, item.array->place(), "finite numbers", std::to_string(value));
    matrix(i / columns, i % columns) = value;
  }
  return matrix;
}

RigidTransform poseOf(const fs::path& input, const ArrayGroup& own, const ArrayGroup& shared,
                      std::size_t index, std::size_t count) {
  for (const ArrayRole role : {ArrayRole::WorldFromCamera, ArrayRole::CameraFromWorld}) {
    const std::optional<ArrayItem> item = findItem(own, shared, role, index, count);
    if (!item) continue;
    const RigidTransform pose =
        poseFromMatrix(item->array->path(), item->array->place(), readMatrixItem(*item, 3, 4));
    return role == ArrayRole::WorldFromCamera ? pose : pose.inverse();
  }
  throw IoError(input, "",
                "an array of poses (" + namesOf(ArrayRole::WorldFromCamera) + " or " +
                    namesOf(ArrayRole::CameraFromWorld) + ")",
                "none");
}

Pinhole cameraOf(const fs::path& input, const std::optional<ArrayItem>& item, const ArrayItem& depth,
                 const ReadOptions& options) {
  checkImageSize(depth.array->path(), depth.array->place(), depth.shape[1], depth.shape[0]);
  const int width = static_cast<int>(depth.shape[1]), height = static_cast<int>(depth.shape[0]);
  if (options.intrinsics) {
    const auto& [fx, fy, cx, cy] = *options.intrinsics;
    return {width, height, fx, fy, cx, cy, {}};
  }
  if (!item)
    throw IoError(input, "",
                  "an array of intrinsics (" + namesOf(ArrayRole::Intrinsics) + "), or --intrinsics", "none");
  return pinholeFromMatrix(item->array->path(), item->array->place(), readMatrixItem(*item, 3, 3), width,
                           height);
}

void checkSides(const NumpyFrame& frame) {
  if (frame.confidence && frame.confidence->shape != frame.depth.shape)
    throw IoError(frame.confidence->array->path(), frame.confidence->array->place(),
                  "a confidence for every depth", "shape " + frame.confidence->array->header().shapeText());
  if (!frame.color) return;
  const std::vector<std::int64_t>& shape = frame.color->shape;
  const bool is_last = shape[2] == 3 || shape[2] == 4;
  if (!is_last && shape[0] != 3 && shape[0] != 4)
    throw IoError(frame.color->array->path(), frame.color->array->place(), "colours of three numbers",
                  "shape " + frame.color->array->header().shapeText());
  checkImageSize(frame.color->array->path(), frame.color->array->place(), is_last ? shape[1] : shape[2],
                 is_last ? shape[0] : shape[1]);
}

void addFrame(NumpySource& source, const fs::path& input, const NumpyLayout& layout, const ArrayGroup& shared,
              std::size_t index, std::size_t count) {
  const bool has_own = !layout.names.empty();
  const ArrayGroup own = has_own ? groupOf(layout.own[index]) : ArrayGroup();
  const auto find = [&](ArrayRole role) { return findItem(own, shared, role, index, count); };
  std::optional<ArrayItem> depth = find(ArrayRole::Depth);
  if (!depth)
    throw IoError(has_own ? layout.own[index].front().path : input, "",
                  "an array of depths (" + namesOf(ArrayRole::Depth) + ")", "none");
  NumpyFrame frame{std::move(*depth), find(ArrayRole::Confidence), find(ArrayRole::Color),
                   has_own ? layout.pictures[index] : fs::path()};
  checkSides(frame);
  ViewHeader header;
  header.name = has_own ? layout.names[index] : std::to_string(index);
  header.world_from_camera = poseOf(input, own, shared, index, count);
  header.projection = cameraOf(input, find(ArrayRole::Intrinsics), frame.depth, source.options);
  if (const auto problems = validate(header.projection); !problems.empty())
    throw IoError(input, "view " + header.name, "a usable camera", problems.front());
  source.headers.push_back(std::move(header));
  source.frames.push_back(std::move(frame));
}

DepthEncoding encodingOf(const NumpySource& source, std::size_t index) {
  const double scale = source.frames[index].depth.array->header().kind == 'f' ? 1.0 : 0.001;
  return encodingFor(source.options, source.headers[index].projection, DepthKind::Z, scale);
}

bool isSaturating(const io::NpyHeader& header) { return header.kind == 'u' && header.bytes == 2; }

Image<float> readImage(const ArrayItem& item) {
  return io::npyImage(item.read(), 0, static_cast<int>(item.shape[1]), static_cast<int>(item.shape[0]));
}

std::uint8_t shadeOf(double value, bool is_float) {
  const double shade = is_float ? std::round(255 * value) : value;
  return shade > 0 ? static_cast<std::uint8_t>(std::min(shade, 255.0)) : std::uint8_t{0};
}

Image<Rgb8> readColor(const ArrayItem& item) {
  const bool is_last = item.shape[2] == 3 || item.shape[2] == 4;
  const auto channels = static_cast<std::size_t>(is_last ? item.shape[2] : item.shape[0]);
  const io::NpyArray numbers = item.read();
  Image<Rgb8> color(static_cast<int>(is_last ? item.shape[1] : item.shape[2]),
                    static_cast<int>(is_last ? item.shape[0] : item.shape[1]));
  for (std::size_t i = 0; i < color.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = is_last ? i * channels + c : c * color.size() + i;
      color.data()[i][c] = shadeOf(numbers[at], numbers.header.kind == 'f');
    }
  }
  return color;
}

DepthMap loadFrame(const NumpySource& source, std::size_t index) {
  const NumpyFrame& frame = source.frames[index];
  Image<float> stored = readImage(frame.depth);
  if (isSaturating(frame.depth.array->header())) std::replace(stored.begin(), stored.end(), 65535.0F, 0.0F);
  DepthMap map;
  map.depth = sensorDepth(std::move(stored), source.headers[index].projection, encodingOf(source, index),
                          source.options);
  if (frame.confidence) map.confidence = readImage(*frame.confidence);
  if (source.options.color == ReadOptions::Color::Skip) return map;
  if (frame.color) map.color = readColor(*frame.color);
  if (!frame.color && !frame.picture.empty()) map.color = readPicture(frame.picture);
  return map;
}

std::string storedText(const io::NpyHeader& header) {
  const char* sign = header.kind == 'f' ? "float " : header.kind == 'i' ? "signed " : "";
  return std::to_string(8 * header.bytes) + "-bit " + sign + "array of numpy";
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::size_t countFrames(const NumpyLayout& layout, const ArrayGroup& shared) {
  if (!layout.names.empty()) return layout.names.size();
  const auto depth = shared.find(ArrayRole::Depth);
  return depth == nullptr ? 1 : frameCount(*depth, ArrayRole::Depth).value_or(1);
}

Detection detect(const fs::path& path) {
  using Fit = Detection::Fit;
  if (!fs::is_directory(path) && !io::isNpz(path)) return {Fit::No, "neither a folder nor a .npz file"};
  const NumpyLayout layout = layoutOf(path);
  if (layout.shared.empty() && layout.names.empty()) return {Fit::No, "no .npz or .npy files"};
  try {
    const ArrayGroup shared = groupOf(layout.shared);
    const ArrayGroup own = layout.own.empty() ? ArrayGroup() : groupOf(layout.own.front());
    const auto has = [&](ArrayRole role) {
      return own.find(role) != nullptr || shared.find(role) != nullptr;
    };
    const std::string depth = namesOf(ArrayRole::Depth);
    if (!has(ArrayRole::Depth)) return {Fit::No, "no array of depths (" + depth + ")"};
    if (!has(ArrayRole::WorldFromCamera) && !has(ArrayRole::CameraFromWorld))
      return {Fit::Partly, "an array of depths, but none of poses"};
    if (!has(ArrayRole::Intrinsics)) return {Fit::Partly, "an array of depths, but none of intrinsics"};
    return {Fit::Fully, counted(countFrames(layout, shared), "depth map") + " with poses and intrinsics"};
  } catch (const Error&) {
    return {Fit::Partly, "arrays that are broken"};
  }
}

}  // namespace

DepthSet readNumpy(const fs::path& path, const ReadOptions& options) {
  const NumpyLayout layout = layoutOf(path);
  if (layout.shared.empty() && layout.names.empty()) throw IoError(path, "", ".npz or .npy files", "none");
  const ArrayGroup shared = groupOf(layout.shared);
  const std::size_t count = countFrames(layout, shared);
  if (count > kMostFrames) throw IoError(path, "", "up to a million frames", std::to_string(count));
  auto source = std::make_shared<NumpySource>();
  source->options = options;
  for (std::size_t i = 0; i < count; ++i) addFrame(*source, path, layout, shared, i, count);
  if (source->frames.empty()) throw IoError(path, "", "a view with a depth map", "none");
  DepthSet set;
  const io::NpyHeader& stored = source->frames.front().depth.array->header();
  const DepthEncoding encoding = encodingOf(*source, 0);
  set.reading = {storedText(stored), encoding.kind, encoding.scale,
                 isSaturating(stored) ? "0 and 65535" : "0, negative, not finite",
                 "world_from_camera (world_from_camera, c2w, pose) or its inverse (camera_from_world, w2c, "
                 "extrinsics), x right, y down, z forward"};
  if (!shared.leftOut().empty())
    set.notes.push_back("arrays left out in favour of others: " + joined(shared.leftOut()));
  set.views =
      ViewSequence(source->headers, [source](std::size_t index) { return loadFrame(*source, index); });
  return set;
}

DepthSetFormat numpyFormat() {
  return {
      "numpy",
      "arrays of numpy, as networks (VGGT, Depth Anything 3, DUSt3R, CUT3R) and scripts save them",
      "SET.npz, or a folder with depth.npy, intrinsics.npy, ..., or with NAME.npz for every frame, or with\n"
      "depth/NAME.npy beside camera/NAME.npz, conf/NAME.npy, color/NAME.png or arrays of all frames\n"
      "depth(s), depth_map(s)        N x H x W, H x W, ...; floats: 1, whole numbers: 0.001\n"
      "intrinsics, intrinsic, K      3x3 for every frame or for all; or --intrinsics fx,fy,cx,cy\n"
      "world_from_camera, cam2world, c2w, pose(s), camera_poses    4x4 or 3x4 world_from_camera\n"
      "camera_from_world, world2cam, w2c, extrinsic(s)             the inverse, camera_from_world\n"
      "confidence, conf, depth_conf  optional\n"
      "color, rgb, images            optional, bytes or floats from 0 to 1\n",
      detect,
      readNumpy,
      writeNumpy};
}

}  // namespace vdbfuse
