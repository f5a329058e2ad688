// SPDX-License-Identifier: Apache-2.0
#include "formats/colmap_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/colmap_fields.h"
#include "formats/sparse_depths.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

// What the parameters of a model are, in their order: f both focal lengths, x and y one of them, c and d the
// principal point, then places in Pinhole::distortion (OpenCV's order), - what must be 0.
struct Model {
  std::string_view name, parameters;
};
constexpr Model kModels[] = {{"SIMPLE_PINHOLE", "fcd"}, {"PINHOLE", "xycd"},
                             {"SIMPLE_RADIAL", "fcd0"}, {"RADIAL", "fcd01"},
                             {"OPENCV", "xycd0123"},    {"FULL_OPENCV", "xycd01234---"}};

const Model& modelOf(ColmapFields& fields) {
  const std::string name = fields.model();
  const auto* const found = std::find_if(std::begin(kModels), std::end(kModels),
                                         [&](const Model& model) { return model.name == name; });
  if (found == std::end(kModels))
    fields.fail("a camera SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV or FULL_OPENCV",
                name.substr(0, 40));
  return *found;
}

int readSide(ColmapFields& fields) {
  constexpr std::uint64_t kLargest = 1 << 20;
  const std::uint64_t side = fields.longId();
  if (side < 1 || side > kLargest) fields.fail("a size of 1 to 1048576 pixels", std::to_string(side));
  return static_cast<int>(side);
}

Pinhole readCamera(ColmapFields& fields) {
  const Model& model = modelOf(fields);
  Pinhole camera;
  camera.width = readSide(fields), camera.height = readSide(fields);
  for (const char parameter : model.parameters) {
    const double value = fields.number();
    if (parameter == 'f' || parameter == 'x') camera.fx = value;
    if (parameter == 'f' || parameter == 'y') camera.fy = value;
    if (parameter == 'c') camera.cx = value - 0.5;
    if (parameter == 'd') camera.cy = value - 0.5;
    if (parameter >= '0' && parameter <= '4')
      camera.distortion[static_cast<std::size_t>(parameter - '0')] = value;
    if (parameter == '-' && value != 0) fields.fail("k4, k5 and k6 of 0", numberText(value));
  }
  return camera;
}

RigidTransform readPose(ColmapFields& fields) {
  double v[7];
  for (double& value : v) value = fields.number();
  const Eigen::Quaterniond turn(v[0], v[1], v[2], v[3]);
  if (!(std::abs(turn.norm() - 1) <= kRotationTolerance))
    fields.fail("a quaternion of length 1", numberText(turn.norm()));
  return Eigen::Translation3d(v[4], v[5], v[6]) * turn.normalized();
}

std::unique_ptr<ColmapFields> require(const fs::path& folder, const std::string& stem) {
  std::unique_ptr<ColmapFields> fields = openColmapFile(folder, stem);
  if (!fields) throw IoError(folder, "", stem + ".bin or " + stem + ".txt", "neither");
  return fields;
}

void readImages(ColmapModel& model, ColmapFields& fields) {
  while (fields.next()) {
    ColmapImage image;
    image.id = fields.id();
    image.camera_from_world = readPose(fields);
    image.camera = fields.id();
    if (model.cameras.count(image.camera) == 0)
      fields.fail("one of the cameras", "camera " + std::to_string(image.camera));
    image.name = fields.name();
    fields.skipPoints();
    model.images.push_back(std::move(image));
  }
}

// Poses of the cameras of a rig by camera; none where it is unknown.
using Rig = std::map<std::uint32_t, std::optional<RigidTransform>>;

std::map<std::uint32_t, Rig> readRigs(ColmapFields& fields) {
  std::map<std::uint32_t, Rig> rigs;
  while (fields.next()) {
    Rig& rig = rigs[fields.id()];
    const std::uint32_t count = fields.id();
    for (std::uint32_t i = 0; i < count; ++i) {
      const bool is_camera = fields.isCamera();
      const std::uint32_t sensor = fields.id();
      std::optional<RigidTransform> sensor_from_rig;
      if (i == 0) sensor_from_rig = RigidTransform::Identity();
      if (i > 0 && fields.flag()) sensor_from_rig = readPose(fields);
      if (is_camera) rig[sensor] = sensor_from_rig;
    }
  }
  return rigs;
}

// camera_from_world by image.
std::map<std::uint64_t, RigidTransform> readFrames(ColmapFields& fields,
                                                   const std::map<std::uint32_t, Rig>& rigs) {
  std::map<std::uint64_t, RigidTransform> poses;
  while (fields.next()) {
    fields.id();
    const std::uint32_t rig_id = fields.id();
    const auto rig = rigs.find(rig_id);
    if (rig == rigs.end()) fields.fail("one of the rigs", "rig " + std::to_string(rig_id));
    const RigidTransform rig_from_world = readPose(fields);
    for (std::uint32_t left = fields.id(); left > 0; --left) {
      const bool is_camera = fields.isCamera();
      const auto sensor = rig->second.find(fields.id());
      const std::uint64_t image = fields.longId();
      if (is_camera && sensor != rig->second.end() && sensor->second)
        poses[image] = *sensor->second * rig_from_world;
    }
  }
  return poses;
}

void takeFrames(ColmapModel& model, const std::map<std::uint64_t, RigidTransform>& poses) {
  constexpr double kTolerance = 1e-6;
  for (ColmapImage& image : model.images) {
    const auto found = poses.find(image.id);
    if (found == poses.end()) continue;
    model.moved += found->second.isApprox(image.camera_from_world, kTolerance) ? 0 : 1;
    image.camera_from_world = found->second;
  }
}

}  // namespace

bool hasColmapModel(const fs::path& folder) {
  const auto has = [&](const char* stem) {
    return isFile(folder / (std::string(stem) + ".bin")) || isFile(folder / (std::string(stem) + ".txt"));
  };
  return has("cameras") && has("images");
}

ColmapModel readColmapModel(const fs::path& folder) {
  ColmapModel model;
  const auto cameras = require(folder, "cameras"), images = require(folder, "images");
  while (cameras->next()) {
    const std::uint32_t id = cameras->id();
    model.cameras[id] = readCamera(*cameras);
  }
  model.images_file = images->path();
  readImages(model, *images);
  const auto rigs = openColmapFile(folder, "rigs"), frames = openColmapFile(folder, "frames");
  if (rigs && frames) takeFrames(model, readFrames(*frames, readRigs(*rigs)));
  std::stable_sort(model.images.begin(), model.images.end(),
                   [](const ColmapImage& a, const ColmapImage& b) { return a.name < b.name; });
  return model;
}

std::vector<std::optional<DepthInterval>> readColmapDepths(const fs::path& folder, const ColmapModel& model) {
  std::vector<RigidTransform> poses;
  std::map<std::uint32_t, std::size_t> index_of_image;
  for (const ColmapImage& image : model.images) {
    index_of_image[image.id] = poses.size();
    poses.push_back(image.camera_from_world);
  }
  SparseDepths depths(std::move(poses));
  const auto points = openColmapFile(folder, "points3D");
  while (points && points->next()) {
    points->longId();
    Eigen::Vector3d position;
    for (double& x : position) x = points->number();
    points->skipColor();
    for (const std::uint32_t image : points->track()) {
      if (const auto found = index_of_image.find(image); found != index_of_image.end())
        depths.add(found->second, position);
    }
  }
  std::vector<std::optional<DepthInterval>> intervals;
  for (std::size_t i = 0; i < model.images.size(); ++i) intervals.push_back(depths.interval(i));
  return intervals;
}

}  // namespace vdbfuse
