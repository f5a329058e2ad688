// SPDX-License-Identifier: Apache-2.0
#include "formats/image_writer.h"
#include "formats/numpy.h"
#include "io/npz_writer.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse {
namespace {

template <class T>
std::string_view bytesOf(const T* values, std::size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(T)};
}

template <int size>
void appendMatrix(io::NpzWriter& file, const std::string& name,
                  const Eigen::Matrix<double, size, size>& matrix) {
  const Eigen::Matrix<double, size, size, Eigen::RowMajor> rows = matrix;
  file.append(name, "<f8", {size, size}, bytesOf(rows.data(), size * size));
}

void appendView(io::NpzWriter& file, const View& view) {
  const auto sides = [](const auto& image) {
    return std::vector<std::int64_t>{image.height(), image.width()};
  };
  const DepthMap& map = view.map;
  file.append("depth", "<f4", sides(map.depth), bytesOf(map.depth.data(), map.depth.size()));
  appendMatrix<3>(file, "intrinsics", intrinsicMatrix(plainPinhole(view, "numpy")));
  appendMatrix<4>(file, "world_from_camera", view.world_from_camera.matrix());
  if (!map.confidence.empty())
    file.append("confidence", "<f4", sides(map.depth), bytesOf(map.confidence.data(), map.confidence.size()));
  if (map.color.empty() || view.color_sensor) return;
  std::vector<std::int64_t> shape = sides(map.color);
  shape.push_back(3);
  file.append("color", "|u1", shape, bytesOf(map.color.data(), map.color.size()));
}

bool haveOneSize(const ViewSequence& views) {
  const Projection& first = views.header(0).projection;
  for (std::size_t i = 1; i < views.size(); ++i) {
    const Projection& other = views.header(i).projection;
    if (imageWidth(other) != imageWidth(first) || imageHeight(other) != imageHeight(first)) return false;
  }
  return true;
}

}  // namespace

void writeNumpy(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions&,
                const Progress& progress) {
  for (std::size_t i = 0; i < views.size(); ++i) plainPinhole(views.header(i), "numpy");
  if (!haveOneSize(views)) {
    forEachView(views, progress, [&](const View& view, const std::string& name) {
      io::NpzWriter file(folder / (name + ".npz"), std::nullopt);
      appendView(file, view);
      file.finish();
    });
    return;
  }
  io::NpzWriter file(folder / "depth_set.npz", static_cast<std::int64_t>(views.size()));
  forEachView(views, progress, [&](const View& view, const std::string&) { appendView(file, view); });
  file.finish();
}

}  // namespace vdbfuse
