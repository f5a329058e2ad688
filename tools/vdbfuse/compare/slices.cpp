// SPDX-License-Identifier: Apache-2.0
#include "compare/slices.h"

#include <algorithm>
#include <cmath>

#include "render_slice.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

constexpr int kLongest = 560;  // pixels
constexpr double kBand = 4;    // voxels from the surface that the colours of distances reach

// Where the slices of one method go and what they show.
struct Slices {
  const fs::path& folder;
  const std::vector<ScalarGrid>& grids;
  const std::string& method;

  // Draws the grid of that name and says where; nothing where there is none.
  PictureFile draw(const std::string& grid, const std::string& file, const LevelSlice& slice) const {
    const bool has_grid =
        std::any_of(grids.begin(), grids.end(), [&](const ScalarGrid& g) { return g.name() == grid; });
    if (!has_grid) return {};
    PictureFile picture = fs::path("slices") / (file + "-" + method + ".png");
    writePng(folder / picture, renderSlice(GridLevels(grids, grid), slice));
    return picture;
  }
};

}  // namespace

SlicePlane choosePlane(const std::string& text, const Box& box, double voxel) {
  if (text != "auto") return parsePlane(text);
  int axis = 0;
  box.sizes().minCoeff(&axis);
  return {axis, voxel * std::round(box.center()[axis] / voxel) + 0.0};  // and not −0
}

void writeSlices(const fs::path& folder, const SlicePlace& place, const std::vector<ScalarGrid>& grids,
                 MethodRecord& record) {
  const Slices slices{folder, grids, record.name};
  const LevelSlice slice{place.plane, place.box, kLongest};
  LevelSlice near_surface = slice, cost = slice, cells = slice;
  near_surface.high = kBand * GridLevels(grids, "surface").finest().frame().voxel;
  cost.high = 1;
  cells.lines = CellLines::Draw;
  record.distance_slice = slices.draw("surface", "distance", near_surface);
  record.evidence_slice = slices.draw("sigma", "sigma", slice);
  record.cell_slice = slices.draw("sigma", "cells", cells);
  record.weight_slice = slices.draw("rho", "rho", cost);
  if (record.weight_slice.empty()) record.weight_slice = slices.draw("weight", "weight", slice);
}

}  // namespace vdbfuse::tool
