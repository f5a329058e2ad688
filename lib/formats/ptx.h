// SPDX-License-Identifier: Apache-2.0
// Leica PTX: scans of a turning scanner as text, one file of one or several, or a folder of such files. Per
// scan:
//
//   columns
//   rows
//   x y z              position of the scanner in the world
//   x y z  (3 lines)   its axes in the world
//   m m m m (4 lines)  matrix M: p_world = p M for a row (x y z 1), so the last row is the translation
//   x y z intensity [r g b]      columns × rows lines, column by column; 0 0 0: no return
//
// Points are in the scanner's axes: x forward, y left, z up. Where M differs from the scanner's own pose, and
// only points taken to that pose lie on a grid of a sensor, they were in other axes (the world's), and a note
// says so. Leica writes each column from below; which end comes first does not matter here: images are turned
// upright (scan_grid.h). Intensities and colours are not read.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Finds where the scans begin and what sensor each had; points are read again when a depth map is asked for,
/// one scan in memory at a time. Throws IoError: a header is unsound, points are missing or no numbers, a
/// matrix is no rigid transform.
DepthSet readPtx(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat ptxFormat();

}  // namespace vdbfuse
