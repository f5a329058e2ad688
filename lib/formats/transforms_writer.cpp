// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "formats/frames.h"
#include "formats/image_writer.h"
#include "formats/photo_writer.h"
#include "formats/transforms.h"
#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Json = nlohmann::ordered_json;

const Pinhole& pinholeOf(const ViewHeader& header) {
  const auto* camera = std::get_if<Pinhole>(&header.projection);
  if (camera == nullptr)
    throw InvalidArgument("view " + header.name, "the format transforms holds pinholes only");
  return *camera;
}

double chooseStep(const ViewSequence& views, const WriteOptions& options, const Progress& progress) {
  constexpr double kMillimetre = 0.001, kSteps = 65534;
  if (options.depth_scale) return *options.depth_scale;
  float largest = 0;
  ProgressStep step(progress, "measure", views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Image<float> depth = views.load(i).map.depth;
    if (!depth.empty()) largest = std::max(largest, *std::max_element(depth.begin(), depth.end()));
    step.advance();
  }
  const bool fits = largest >= 1 && largest <= kSteps * kMillimetre;
  return fits || largest == 0 ? kMillimetre : static_cast<double>(largest) / kSteps;
}

// The camera of the picture, where that is larger than the depth map.
Pinhole statedCamera(const View& view) {
  const Pinhole& camera = pinholeOf(view);
  const Image<Rgb8>& color = view.map.color;
  const bool has_own_size = !color.empty() && !view.color_sensor && !color.sameSize(view.map.depth);
  return has_own_size ? resized(camera, color.width(), color.height()) : camera;
}

void addCamera(Json& json, const Pinhole& camera) {
  json["fl_x"] = camera.fx, json["fl_y"] = camera.fy;
  json["cx"] = camera.cx + 0.5, json["cy"] = camera.cy + 0.5;
  json["w"] = camera.width, json["h"] = camera.height;
  const char* keys[] = {"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < 5; ++i) json[keys[i]] = camera.distortion[i];
}

std::string textOf(const Json& json) {
  try {
    return json.dump(2) + "\n";
  } catch (const nlohmann::json::exception&) {
    throw InvalidArgument("views", "JSON cannot hold names that are no UTF-8");
  }
}

Json poseOf(const RigidTransform& world_from_camera) {
  Eigen::Matrix4d matrix = world_from_camera.matrix();
  matrix.middleCols<2>(1) *= -1;
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3)});
  return rows;
}

// Everything but the frames: the camera there where it is one for all, else with each frame.
Json rootOf(const std::vector<Pinhole>& cameras, Json& frames) {
  Json root = {{"camera_model", "OPENCV"}};
  const bool is_one =
      std::all_of(cameras.begin(), cameras.end(), [&](const Pinhole& c) { return c == cameras[0]; });
  if (is_one) addCamera(root, cameras.front());
  for (std::size_t i = 0; i < cameras.size() && !is_one; ++i) addCamera(frames[i], cameras[i]);
  return root;
}

}  // namespace

void writeTransforms(const std::filesystem::path& folder, const ViewSequence& views,
                     const WriteOptions& options, const Progress& progress) {
  for (std::size_t i = 0; i < views.size(); ++i) pinholeOf(views.header(i));
  const double step = chooseStep(views, options, progress);
  createFolder(folder / "depth");
  createFolder(folder / "images");
  std::vector<Pinhole> cameras;
  Json frames = Json::array();
  forEachView(views, progress, [&](const View& view, const std::string& name) {
    writeDepthPng(folder / "depth" / (name + ".png"), view, step);
    writeColor(folder / "images" / (name + ".png"), view);
    cameras.push_back(statedCamera(view));
    frames.push_back({{"file_path", "images/" + name + ".png"},
                      {"depth_file_path", "depth/" + name + ".png"},
                      {"depth_path", "depth/" + name + ".png"},
                      {"transform_matrix", poseOf(view.world_from_camera)}});
  });
  Json root = rootOf(cameras, frames);
  root["depth_unit_scale_factor"] = step;
  root["integer_depth_scale"] = step;
  root["frames"] = std::move(frames);
  io::writeFileBytes(folder / "transforms.json", textOf(root));
}

void writeTransformsImages(const std::filesystem::path& folder, const PhotographSequence& photographs,
                           const ImageWriteOptions&, const Progress& progress) {
  std::vector<Pinhole> cameras;
  Json frames = Json::array();
  const std::vector<std::string> names = writePictures(folder, "images", photographs, progress);
  for (std::size_t i = 0; i < names.size(); ++i) {
    cameras.push_back(photographs.header(i).camera);
    frames.push_back({{"file_path", "images/" + names[i] + ".png"},
                      {"transform_matrix", poseOf(photographs.header(i).world_from_camera)}});
  }
  Json root = rootOf(cameras, frames);
  root["frames"] = std::move(frames);
  io::writeFileBytes(folder / "transforms.json", textOf(root));
}

}  // namespace vdbfuse
