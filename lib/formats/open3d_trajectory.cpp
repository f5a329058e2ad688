// SPDX-License-Identifier: Apache-2.0
#include "formats/open3d_trajectory.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/camera_text.h"
#include "formats/image_writer.h"
#include "formats/json_fields.h"
#include "io/file_bytes.h"
#include "io/text_cursor.h"
#include "io/text_lines.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse {
namespace {

using Json = nlohmann::ordered_json;

std::int64_t wholeNumber(io::TextCursor& cursor, std::string_view word) {
  const std::optional<std::int64_t> value = io::parseInteger(word);
  if (!value) cursor.fail("a line of three whole numbers", word);
  return *value;
}

Eigen::Matrix4d readRows(io::TextCursor& cursor) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix(row, column) = cursor.number();
      if (!std::isfinite(matrix(row, column)))
        cursor.failWith("a finite number", numberText(matrix(row, column)));
    }
  }
  return matrix;
}

Pinhole cameraOf(const std::filesystem::path& path, const JsonField& intrinsic) {
  constexpr int kLargestSide = 1 << 20;
  const int width = intrinsic.at("width").whole(1, kLargestSide),
            height = intrinsic.at("height").whole(1, kLargestSide);
  const JsonField matrix = intrinsic.at("intrinsic_matrix");
  const Eigen::VectorXd columns = matrix.numbers(9);
  return pinholeFromMatrix(path, matrix.place(), Eigen::Map<const Eigen::Matrix3d>(columns.data()), width,
                           height);
}

Json matrixJson(const Eigen::MatrixXd& matrix) {
  return Json(std::vector<double>(matrix.data(), matrix.data() + matrix.size()));
}

Json intrinsicJson(const Pinhole& camera) {
  return {{"width", camera.width},
          {"height", camera.height},
          {"intrinsic_matrix", matrixJson(intrinsicMatrix(camera))}};
}

}  // namespace

std::vector<TrajectoryEntry> readLogTrajectory(const std::filesystem::path& path) {
  const std::string text = io::readFileBytes(path);
  io::TextCursor cursor(path, text);
  std::vector<TrajectoryEntry> entries;
  std::ptrdiff_t line = 1, counted_to = 0;
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word()) {
    TrajectoryEntry entry;
    const auto position = static_cast<std::ptrdiff_t>(cursor.position());
    line += std::count(text.begin() + counted_to, text.begin() + position, '\n');
    counted_to = position;
    entry.place = "line " + std::to_string(line);
    entry.index = wholeNumber(cursor, word);
    for (int i = 0; i < 2; ++i) wholeNumber(cursor, cursor.wordOnLine());
    entry.world_from_camera = poseFromMatrix(path, "line " + std::to_string(line + 1), readRows(cursor));
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::vector<TrajectoryEntry> readJsonTrajectory(const std::filesystem::path& path) {
  const JsonField parameters = JsonField::readFile(path).at("parameters");
  std::vector<TrajectoryEntry> entries;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const JsonField extrinsic = parameters[i].at("extrinsic");
    const Eigen::VectorXd columns = extrinsic.numbers(16);
    TrajectoryEntry entry;
    entry.place = parameters[i].place();
    entry.camera = cameraOf(path, parameters[i].at("intrinsic"));
    entry.world_from_camera =
        poseFromMatrix(path, extrinsic.place(), Eigen::Map<const Eigen::Matrix4d>(columns.data())).inverse();
    entries.push_back(std::move(entry));
  }
  return entries;
}

Pinhole readOpen3dIntrinsic(const std::filesystem::path& path) {
  return cameraOf(path, JsonField::readFile(path));
}

std::string logTrajectoryText(const std::vector<TrajectoryEntry>& trajectory) {
  std::string text;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::string index = std::to_string(i);
    text += index + " " + index + " " + std::to_string(i + 1) + "\n" +
            matrixText(trajectory[i].world_from_camera.matrix());
  }
  return text;
}

std::string jsonTrajectoryText(const std::vector<TrajectoryEntry>& trajectory) {
  Json parameters = Json::array();
  for (const TrajectoryEntry& entry : trajectory) {
    parameters.push_back({{"class_name", "PinholeCameraParameters"},
                          {"extrinsic", matrixJson(entry.world_from_camera.inverse().matrix())},
                          {"intrinsic", intrinsicJson(*entry.camera)},
                          {"version_major", 1},
                          {"version_minor", 0}});
  }
  const Json root = {{"class_name", "PinholeCameraTrajectory"},
                     {"parameters", std::move(parameters)},
                     {"version_major", 1},
                     {"version_minor", 0}};
  return root.dump(2) + "\n";
}

std::string open3dIntrinsicText(const Pinhole& camera) { return intrinsicJson(camera).dump(2) + "\n"; }

}  // namespace vdbfuse
