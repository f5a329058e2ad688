// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/report/grid_levels.h"
#include "vdbfuse/report/slice.h"

namespace vdbfuse::tool {

struct SliceRequest {
  std::filesystem::path file;  ///< .vdb
  std::string plane;           ///< x=VALUE, y=VALUE or z=VALUE, world units
  std::string grid;            ///< name; empty: the first in the file
  int longest = 800;           ///< pixels along the longer side
  bool cells = false;          ///< lines between the cells as well
  double low = 0, high = 0;    ///< values at the ends of the colours; equal: from the data
};

/// x=VALUE, y=VALUE or z=VALUE. Throws InvalidArgument.
SlicePlane parsePlane(const std::string& text);

enum class CellLines { None, Draw };

/// A picture of grids in memory: the finest known value at each point.
struct LevelSlice {
  SlicePlane plane;
  Box box;  ///< empty: around all voxels that hold a value
  int longest = 800;
  CellLines lines = CellLines::None;
  double low = 0, high = 0;  ///< as of SliceRequest
};

/// Colours by the name of the finest grid, as renderSlice() below. REQUIRES: a grid, and one with values or a
/// box.
Image<Rgb8> renderSlice(const GridLevels& levels, const LevelSlice& slice);

/// A slice through a grid and its coarser levels (`name_level1`, …): the finest known value at each point.
/// rho, support and weight are drawn from dark to light, everything else around zero. Throws IoError,
/// InvalidArgument.
Image<Rgb8> renderSlice(const SliceRequest& request);

}  // namespace vdbfuse::tool
