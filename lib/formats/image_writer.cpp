// SPDX-License-Identifier: Apache-2.0
#include "formats/image_writer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <set>
#include <sstream>
#include <utility>

#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/distortion.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

bool canBeAFileName(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.size() < 200 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c > ' ' && c != '/' && c != '\\'; });
}

}  // namespace

std::string numberedName(std::size_t index, int digits) {
  std::ostringstream text;
  text << std::setw(digits) << std::setfill('0') << index;
  return text.str();
}

std::vector<std::string> fileNames(std::vector<std::string> names) {
  const bool all_usable = std::all_of(names.begin(), names.end(), canBeAFileName) &&
                          std::set<std::string>(names.begin(), names.end()).size() == names.size();
  for (std::size_t i = 0; i < names.size() && !all_usable; ++i) names[i] = numberedName(i, 8);
  return names;
}

std::vector<std::string> fileNames(const ViewSequence& views) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < views.size(); ++i) names.push_back(views.header(i).name);
  return fileNames(std::move(names));
}

void forEachView(const ViewSequence& views, const Progress& progress,
                 const std::function<void(const View& view, const std::string& name)>& write) {
  const std::vector<std::string> names = fileNames(views);
  ProgressStep step(progress, "write", views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    write(views.load(i), names[i]);
    step.advance();
  }
}

Pinhole plainPinhole(const ViewHeader& header, const std::string& format) {
  const auto* camera = std::get_if<Pinhole>(&header.projection);
  if (camera == nullptr || isDistorted(*camera))
    throw InvalidArgument("view " + header.name,
                          "the format " + format + " holds pinholes without distortion only");
  return *camera;
}

Pinhole commonPinhole(const ViewSequence& views, const std::string& format) {
  const Pinhole camera = plainPinhole(views.header(0), format);
  for (std::size_t i = 1; i < views.size(); ++i) {
    if (plainPinhole(views.header(i), format) != camera)
      throw InvalidArgument(
          "view " + views.header(i).name,
          "the format " + format + " holds one camera, and this view has another than the first");
  }
  return camera;
}

std::string exactText(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, end);
}

std::string numbersText(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += " " + exactText(number);
  return text;
}

std::string matrixText(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < matrix.cols(); ++column)
      text += exactText(matrix(row, column)) + (column + 1 < matrix.cols() ? " " : "\n");
  }
  return text;
}

void writeDepthPng(const std::filesystem::path& path, const View& view, double scale) {
  constexpr double kLargest = 65534;
  const Image<float>& depth = view.map.depth;
  Image<std::uint16_t> stored(depth.width(), depth.height(), std::uint16_t{0});
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth.data()[i] == kInvalidDepth) continue;
    const double steps = std::round(depth.data()[i] / scale);
    if (!(steps >= 1 && steps <= kLargest)) {
      throw InvalidArgument("view " + view.name, "depth " + numberText(depth.data()[i]) +
                                                     " does not fit into 16 bits in steps of " +
                                                     numberText(scale) + "; choose another scale");
    }
    stored.data()[i] = static_cast<std::uint16_t>(steps);
  }
  writePng(path, stored);
}

void writeColor(const std::filesystem::path& path, const View& view) {
  if (!view.map.color.empty() && !view.color_sensor) writePng(path, view.map.color);
}

void createFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(folder, "the folder cannot be created: " + error.message());
  if (!std::filesystem::is_directory(folder)) throw IoError(folder, "", "a folder to write to", "a file");
}

}  // namespace vdbfuse
