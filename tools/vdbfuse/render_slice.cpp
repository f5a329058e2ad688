// SPDX-License-Identifier: Apache-2.0
#include "render_slice.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vdbfuse/base/errors.h"

namespace vdbfuse::tool {
namespace {

// The grid and its coarser levels, finest first.
std::vector<ScalarGrid> readLevels(const SliceRequest& request) {
  const std::vector<std::string> names = gridNames(request.file);
  std::vector<ScalarGrid> levels;
  levels.push_back(readGrid(request.file, request.grid));
  const std::string name = levels.front().name();
  for (int level = 1; level <= 12; ++level) {
    const std::string coarser = name + "_level" + std::to_string(level);
    if (std::find(names.begin(), names.end(), coarser) != names.end()) {
      levels.push_back(readGrid(request.file, coarser));
    }
  }
  return levels;
}

// A number for each cell, so that neighbours have different ones, exact in a float.
double numberOf(const GridLevels::Cell& cell) {
  std::uint64_t number = cell.level;
  for (int a = 0; a < 3; ++a)
    number = number * 0x9e3779b97f4a7c15ULL + static_cast<std::uint32_t>(cell.voxel[a]);
  return static_cast<double>((number ^ number >> 32) & 0xffffff);
}

// Lines between cells, like Fig. 3 of the paper.
void drawCells(const Image<float>& numbers, Image<Rgb8>& picture) {
  const auto darken = [](Rgb8& pixel) {
    for (std::uint8_t& channel : pixel) channel = static_cast<std::uint8_t>(channel * 2 / 5);
  };
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const bool right = x + 1 < picture.width() && numbers(x, y) != numbers(x + 1, y);
      const bool below = y + 1 < picture.height() && numbers(x, y) != numbers(x, y + 1);
      if (right || below) darken(picture(x, y));
    }
  }
}

}  // namespace

SlicePlane parsePlane(const std::string& text) {
  const bool has_axis = text.size() > 2 && text[0] >= 'x' && text[0] <= 'z' && text[1] == '=';
  std::size_t used = 0;
  double value = 0;
  try {
    if (has_axis) value = std::stod(text.substr(2), &used);
  } catch (const std::exception&) {
  }
  if (!has_axis || used != text.size() - 2) {
    throw InvalidArgument("--slice", "expected x=VALUE, y=VALUE or z=VALUE, found '" + text + "'");
  }
  return {text[0] - 'x', value};
}

Image<Rgb8> renderSlice(const GridLevels& levels, const LevelSlice& slice) {
  const Box box = slice.box.isEmpty() ? levels.box() : slice.box;
  const auto field = [&](const Eigen::Vector3d& point) { return levels.at(point).value; };
  const std::string& name = levels.finest().name();
  SliceOptions options;
  if (name == "rho" || name == "support" || name == "weight") options.colors = SliceColors::Sequential;
  options.low = slice.low, options.high = slice.high;
  Image<Rgb8> picture = drawSlice(sampleSlice(field, box, slice.plane, slice.longest), options);
  if (slice.lines == CellLines::Draw) {
    const auto number = [&](const Eigen::Vector3d& point) { return numberOf(levels.at(point)); };
    drawCells(sampleSlice(number, box, slice.plane, slice.longest), picture);
  }
  return picture;
}

Image<Rgb8> renderSlice(const SliceRequest& request) {
  const SlicePlane plane = parsePlane(request.plane);
  const std::vector<ScalarGrid> grids = readLevels(request);
  const GridLevels levels(grids, grids.front().name());
  const Box box = levels.box();
  if (box.isEmpty()) throw IoError(request.file, "", "a grid with values", "none");
  const CellLines lines = request.cells ? CellLines::Draw : CellLines::None;
  return renderSlice(levels, {plane, box, request.longest, lines, request.low, request.high});
}

}  // namespace vdbfuse::tool
