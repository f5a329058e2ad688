// SPDX-License-Identifier: Apache-2.0
#include "formats/pcd.h"

#include <memory>
#include <optional>

#include "formats/pcd_header.h"
#include "formats/pcl_part.h"
#include "formats/stored_depth.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kSuffix = ".pcd";

struct Clouds {
  std::vector<fs::path> paths;
  std::vector<Projection> projections;
  std::vector<RigidTransform> camera_from_stored;  // identity, or out of the world
  ReadOptions options;
};

std::vector<fs::path> cloudsAt(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> paths;
  for (const std::string& name : filesEndingWith(path, kSuffix)) paths.push_back(path / name);
  return paths;
}

std::optional<Pinhole> cameraOf(const PointImage& points) {
  try {
    return fitPinhole(points);
  } catch (const InvalidArgument&) {
    return std::nullopt;
  }
}

void addCamera(const PointImage& points, const ViewHeader& header, Clouds& clouds) {
  RigidTransform camera_from_stored = RigidTransform::Identity();
  std::optional<Pinhole> camera = cameraOf(points);
  if (!camera) {
    camera_from_stored = header.world_from_camera.inverse();
    camera = cameraOf(moved(points, camera_from_stored));
  }
  if (!camera)
    throw IoError(clouds.paths[clouds.projections.size()], "",
                  "points of a pinhole camera, one for each pixel",
                  "points that no pinhole camera sees at their pixels");
  clouds.projections.emplace_back(*camera);
  clouds.camera_from_stored.push_back(camera_from_stored);
}

DepthMap loadCloud(const Clouds& clouds, std::size_t index) {
  const PointImage points = moved(io::readPcdPoints(clouds.paths[index]), clouds.camera_from_stored[index]);
  const Projection& projection = clouds.projections[index];
  if (points.width() != imageWidth(projection) || points.height() != imageHeight(projection))
    throw IoError(clouds.paths[index], "changed since its header was read");
  View view = viewFromPoints(points, projection, RigidTransform::Identity());
  limitPointDepth(view.map.depth, clouds.options);
  return view.map;
}

// A sound header of a single row; what is broken is for the reader to say.
bool isUnorganised(const fs::path& path) {
  constexpr std::size_t kLongestHeader = 64 * 1024;
  try {
    return io::parsePcdLayout(path, io::readFileStart(path, kLongestHeader)).height < 2;
  } catch (const Error&) {
    return false;
  }
}

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path) && path.extension() != kSuffix)
    return {Detection::Fit::No, "not a folder and no .pcd file"};
  const std::vector<fs::path> clouds = cloudsAt(path);
  if (clouds.empty()) return {Detection::Fit::No, "no *.pcd"};
  if (isUnorganised(clouds.front())) return {Detection::Fit::Partly, "clouds that are not organised"};
  return {Detection::Fit::Fully, counted(clouds.size(), "cloud")};
}

}  // namespace

DepthSet readPcd(const fs::path& path, const ReadOptions& options) {
  requirePointOptions(options, DepthKind::Z, "pcd");
  auto clouds = std::make_shared<Clouds>();
  clouds->options = options;
  clouds->paths = cloudsAt(path);
  if (clouds->paths.empty()) throw IoError(path, "", "point clouds (*.pcd)", "none");
  std::vector<ViewHeader> headers;
  for (const fs::path& file : clouds->paths) {
    const io::PcdHeader stored = io::readPcdHeader(file);
    ViewHeader header;
    header.name = file.stem().string();
    header.world_from_camera = stored.viewpoint;
    addCamera(io::readPcdPoints(file), header, *clouds);
    header.projection = clouds->projections.back();
    headers.push_back(std::move(header));
  }
  DepthSet set;
  std::size_t in_world = 0;
  for (const RigidTransform& t : clouds->camera_from_stored) in_world += !t.matrix().isIdentity();
  if (in_world > 0)
    set.notes.push_back(counted(in_world, "cloud") + " in world coordinates, taken back by VIEWPOINT");
  set.reading = {"x y z as 4-byte floats", std::nullopt, options.depth_scale.value_or(1.0), "not finite",
                 "VIEWPOINT is world_from_camera"};
  set.views =
      ViewSequence(std::move(headers), [clouds](std::size_t index) { return loadCloud(*clouds, index); });
  return set;
}

DepthSetFormat pcdFormat() {
  return {
      "pcd", "organised point clouds of the Point Cloud Library, one file or a folder",
      "NAME.pcd   ascii, binary or compressed; x y z as 4-byte floats in the sensor's frame; HEIGHT above "
      "1;\n"
      "           VIEWPOINT is world_from_camera\n",
      detect, readPcd};
}

}  // namespace vdbfuse
