// SPDX-License-Identifier: Apache-2.0
#include "compare/slices.h"

#include <cmath>

#include "render_slice.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

constexpr int kLongest = 560;  // pixels
constexpr double kBand = 4;    // voxels from the surface that the colours of distances reach

using Levels = std::vector<const ScalarGrid*>;

// The grid of that name and its coarser levels.
Levels levelsOf(const std::vector<ScalarGrid>& grids, const std::string& name) {
  Levels levels;
  for (const ScalarGrid& grid : grids)
    if (grid.name() == name || grid.name().starts_with(name + "_level")) levels.push_back(&grid);
  return levels;
}

// Draws one and says where; nothing where there is no such grid.
PictureFile draw(const fs::path& folder, const std::string& file, const Levels& levels,
                 const LevelSlice& slice) {
  if (levels.empty()) return {};
  PictureFile picture = fs::path("slices") / (file + ".png");
  writePng(folder / picture, renderSlice(levels, slice));
  return picture;
}

}  // namespace

SlicePlane choosePlane(const std::string& text, const Box& box, double voxel) {
  if (text != "auto") return parsePlane(text);
  int axis = 0;
  box.sizes().minCoeff(&axis);
  return {axis, voxel * std::round(box.center()[axis] / voxel) + 0.0};  // and not −0
}

void writeSlices(const fs::path& folder, const SlicePlace& place, const std::vector<ScalarGrid>& grids,
                 MethodRecord& record) {
  const LevelSlice slice{place.plane, place.box, kLongest};
  const Levels distance = levelsOf(grids, "surface"), sigma = levelsOf(grids, "sigma");
  LevelSlice near_surface = slice, cost = slice, cells = slice;
  near_surface.high = kBand * distance.front()->frame().voxel;
  cost.high = 1;
  cells.lines = CellLines::Draw;
  record.distance_slice = draw(folder, "distance-" + record.name, distance, near_surface);
  record.evidence_slice = draw(folder, "sigma-" + record.name, sigma, slice);
  record.cell_slice = draw(folder, "cells-" + record.name, sigma, cells);
  record.weight_slice = draw(folder, "rho-" + record.name, levelsOf(grids, "rho"), cost);
  if (record.weight_slice.empty())
    record.weight_slice = draw(folder, "weight-" + record.name, levelsOf(grids, "weight"), slice);
}

}  // namespace vdbfuse::tool
