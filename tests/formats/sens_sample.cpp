// SPDX-License-Identifier: Apache-2.0
#include "formats/sens_sample.h"

#include <turbojpeg.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::test {
namespace {

template <class Number>
void put(std::string& bytes, Number value) {
  char buffer[sizeof value];
  std::memcpy(buffer, &value, sizeof value);
  bytes.append(buffer, sizeof value);
}

void putMatrix(std::string& bytes, const Eigen::Matrix4f& matrix) {
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) put(bytes, matrix(row, column));
  }
}

Eigen::Matrix4f intrinsicsOf(const View& view) {
  const auto& camera = std::get<Pinhole>(view.projection);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix(0, 0) = camera.fx, matrix(1, 1) = camera.fy, matrix(0, 2) = camera.cx, matrix(1, 2) = camera.cy;
  return matrix.cast<float>();
}

std::string jpeg(const Image<Rgb8>& image) {
  const tjhandle encoder = tjInitCompress();
  unsigned char* data = nullptr;
  unsigned long size = 0;
  tjCompress2(encoder, image.data()->data(), image.width(), 0, image.height(), TJPF_RGB, &data, &size,
              TJSAMP_444, 95, 0);
  std::string bytes(reinterpret_cast<const char*>(data), size);
  tjFree(data);
  tjDestroy(encoder);
  return bytes;
}

std::string colorBytes(const Image<Rgb8>& image, int kind) {
  if (image.empty()) return {};
  if (kind == 0) return {reinterpret_cast<const char*>(image.data()), 3 * image.size()};
  if (kind == 2) return jpeg(image);
  const TemporaryFolder folder;
  writePng(folder / "a.png", image);
  return readText(folder / "a.png");
}

std::string depthBytes(const Image<float>& depth, int kind) {
  std::string raw;
  for (const float d : depth) put(raw, static_cast<std::uint16_t>(std::lround(1000 * d)));
  if (kind == 0) return raw;
  std::string packed(compressBound(raw.size()), '\0');
  uLongf length = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(raw.data()),
           raw.size());
  return packed.substr(0, length);
}

}  // namespace

SensRecording tinyRecording(int color, int depth) {
  SensRecording recording;
  recording.views = tinyViews();
  recording.color = color, recording.depth = depth;
  recording.color_intrinsics = intrinsicsOf(recording.views.front());
  return recording;
}

std::string sensBytes(const SensRecording& recording) {
  const View& first = recording.views.front();
  std::string bytes;
  put(bytes, std::uint32_t{4});
  put(bytes, std::uint64_t{6}), bytes += "sensor";
  putMatrix(bytes, recording.color_intrinsics), putMatrix(bytes, recording.color_extrinsics);
  putMatrix(bytes, intrinsicsOf(first)), putMatrix(bytes, recording.depth_extrinsics);
  put(bytes, std::int32_t{recording.color}), put(bytes, std::int32_t{recording.depth});
  for (const int side :
       {first.map.color.width(), first.map.color.height(), first.map.depth.width(), first.map.depth.height()})
    put(bytes, static_cast<std::uint32_t>(side));
  put(bytes, 1000.0F);
  put(bytes, std::uint64_t{recording.views.size()});
  for (const View& view : recording.views) {
    putMatrix(bytes, view.world_from_camera.matrix().cast<float>());
    put(bytes, std::uint64_t{1}), put(bytes, std::uint64_t{2});
    const std::string color = colorBytes(view.map.color, recording.color),
                      depth = depthBytes(view.map.depth, recording.depth);
    put(bytes, std::uint64_t{color.size()}), put(bytes, std::uint64_t{depth.size()});
    bytes += color + depth;
  }
  return bytes + std::string(8, '\0');  // no frames of an inertial unit
}

}  // namespace vdbfuse::test
