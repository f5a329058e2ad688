// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/colmap.h"
#include "formats/colmap_model_writer.h"
#include "formats/frames.h"
#include "formats/image_writer.h"
#include "io/colmap_map.h"
#include "io/file_bytes.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

struct Observation {
  std::size_t view = 0;
  double x = 0, y = 0;  ///< pixels of the stated camera, centres at .5
};

// A point of the surface and where it is seen: stereo_fusion compares views that have some in common.
struct SparsePoint {
  Eigen::Vector3d position;
  Rgb8 color{};
  std::vector<Observation> seen;
};

bool hasPicture(const View& view) { return !view.map.color.empty() && !view.color_sensor; }

Image<Rgb8> pictureOf(const View& view) {
  if (hasPicture(view)) return view.map.color;
  return {view.map.depth.width(), view.map.depth.height(), Rgb8{128, 128, 128}};
}

// Points of a regular grid of pixels.
void addPoints(std::vector<SparsePoint>& points, const View& view, std::size_t count) {
  const Image<float>& depth = view.map.depth;
  const auto area = static_cast<double>(depth.size()) / static_cast<double>(count);
  const int step = std::max(1, static_cast<int>(std::sqrt(area)));
  for (int y = step / 2; y < depth.height(); y += step) {
    for (int x = step / 2; x < depth.width(); x += step) {
      if (depth(x, y) == kInvalidDepth) continue;
      SparsePoint point{worldPoint(view, x, y), {128, 128, 128}, {}};
      if (hasPicture(view) && view.map.color.sameSize(depth)) point.color = view.map.color(x, y);
      points.push_back(std::move(point));
    }
  }
}

// Where the view sees the points: where its depth is theirs to one per cent.
void addObservations(std::vector<SparsePoint>& points, const View& view, std::size_t index,
                     const Pinhole& stated) {
  constexpr double kTolerance = 0.01;
  const RigidTransform camera_from_world = view.world_from_camera.inverse();
  const Image<float>& depth = view.map.depth;
  const double scale_x = static_cast<double>(stated.width) / depth.width(),
               scale_y = static_cast<double>(stated.height) / depth.height();
  for (SparsePoint& point : points) {
    const auto pixel = project(view.projection, camera_from_world * point.position);
    if (!pixel || !(std::abs(pixel->x) < 1e6 && std::abs(pixel->y) < 1e6)) continue;
    const int x = nearestPixel(pixel->x), y = nearestPixel(pixel->y);
    if (!depth.contains(x, y) || depth(x, y) == kInvalidDepth) continue;
    if (std::abs(depth(x, y) - pixel->depth) > kTolerance * pixel->depth) continue;
    point.seen.push_back({index, (pixel->x + 0.5) * scale_x, (pixel->y + 0.5) * scale_y});
  }
}

// Unit normals in the camera's frame, towards the camera; 0 where there is no depth.
std::vector<Image<float>> normalsOf(const View& view) {
  const Image<float>& depth = view.map.depth;
  std::vector<Image<float>> normals(3, Image<float>(depth.width(), depth.height(), 0.0F));
  const auto is_valid = [&](int x, int y) { return depth.contains(x, y) && depth(x, y) != kInvalidDepth; };
  const auto point = [&](int x, int y) { return unproject(view.projection, x, y, depth(x, y)); };
  // Between the neighbours on both sides, where they are valid.
  const auto tangent = [&](int x, int y, int dx, int dy) -> Eigen::Vector3d {
    const bool ahead = is_valid(x + dx, y + dy), behind = is_valid(x - dx, y - dy);
    const Eigen::Vector3d end = ahead ? point(x + dx, y + dy) : point(x, y);
    return end - (behind ? point(x - dx, y - dy) : point(x, y));
  };
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!is_valid(x, y)) continue;
      const Eigen::Vector3d ray = point(x, y).normalized();
      Eigen::Vector3d normal = tangent(x, y, 0, 1).cross(tangent(x, y, 1, 0));
      normal = normal.norm() > 0 ? normal.normalized() : -ray;
      if (normal.dot(ray) > 0) normal = -normal;
      for (std::size_t i = 0; i < 3; ++i)
        normals[i](x, y) = static_cast<float>(normal[static_cast<Eigen::Index>(i)]);
    }
  }
  return normals;
}

ColmapView writeView(const fs::path& folder, const View& view, const std::string& name) {
  const std::string file = name + ".png";
  const Image<Rgb8> picture = pictureOf(view);
  writePng(folder / "images" / file, picture);
  io::writeColmapMap(folder / "stereo/depth_maps" / (file + ".geometric.bin"), {view.map.depth});
  io::writeColmapMap(folder / "stereo/normal_maps" / (file + ".geometric.bin"), normalsOf(view));
  return {file, resized(plainPinhole(view, "colmap"), picture.width(), picture.height()),
          view.world_from_camera};
}

// The lists of images and of points, which name each other.
void writeModel(const fs::path& folder, const std::vector<ColmapView>& views,
                const std::vector<SparsePoint>& points) {
  std::vector<std::string> seen(views.size());
  std::vector<std::size_t> counts(views.size(), 0);
  std::string point_text = kColmapPointTitle;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const SparsePoint& p = points[i];
    if (p.seen.size() < 2) continue;
    const std::string id = std::to_string(i + 1);
    point_text += id + numbersText({p.position.x(), p.position.y(), p.position.z()});
    for (const std::uint8_t shade : p.color) point_text += " " + std::to_string(shade);
    point_text += " 0";
    for (const Observation& o : p.seen) {
      point_text += " " + std::to_string(o.view + 1) + " " + std::to_string(counts[o.view]++);
      seen[o.view] += (seen[o.view].empty() ? "" : " ") + exactText(o.x) + " " + exactText(o.y) + " " + id;
    }
    point_text += "\n";
  }
  writeColmapText(folder / "sparse", views, seen, point_text);
}

void writeConfigurations(const fs::path& folder, const std::vector<ColmapView>& views) {
  std::string fusion, stereo;
  for (const ColmapView& view : views) {
    fusion += view.file + "\n";
    stereo += view.file + "\n__auto__, 20\n";
  }
  io::writeFileBytes(folder / "stereo/fusion.cfg", fusion);
  io::writeFileBytes(folder / "stereo/patch-match.cfg", stereo);
}

}  // namespace

void writeColmap(const fs::path& folder, const ViewSequence& views, const WriteOptions&,
                 const Progress& progress) {
  constexpr std::size_t kMostPoints = 20000, kLeastOfAView = 16, kMostOfAView = 400;
  for (std::size_t i = 0; i < views.size(); ++i) plainPinhole(views.header(i), "colmap");
  for (const char* name :
       {"images", "sparse", "stereo/depth_maps", "stereo/normal_maps", "stereo/consistency_graphs"})
    createFolder(folder / name);
  std::vector<SparsePoint> points;
  const std::size_t of_a_view = std::clamp(kMostPoints / views.size(), kLeastOfAView, kMostOfAView);
  ProgressStep step(progress, "sample", views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    addPoints(points, views.load(i), of_a_view);
    step.advance();
  }
  std::vector<ColmapView> written;
  forEachView(views, progress, [&](const View& view, const std::string& name) {
    written.push_back(writeView(folder, view, name));
    addObservations(points, view, written.size() - 1, written.back().camera);
  });
  writeModel(folder, written, points);
  writeConfigurations(folder, written);
}

}  // namespace vdbfuse
