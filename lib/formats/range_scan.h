// SPDX-License-Identifier: Apache-2.0
// Range scans as PLY files: a point a pixel of a grid, in the scan's own frame.
#pragma once

#include <filesystem>

#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {

/// A PLY file whose header says `obj_info num_cols W` and `obj_info num_rows H`, with vertices x, y, z and an
/// element range_grid of W·H lists vertex_indices, row by row, each empty or one vertex. Ascii or binary.
/// Coordinates are multiplied by `scale`. Throws IoError.
PointImage readRangeScan(const std::filesystem::path& path, double scale);

/// The image with its columns, its rows or both in the opposite order.
PointImage mirrored(const PointImage& points, bool columns, bool rows);

/// The depths of a sensor's pixels from points that lie near their centres only: each point's depth is taken
/// to the centre along the surface through its neighbours, not further than the flatter side of it says.
/// REQUIRES: the image is of the projection's size.
Image<float> depthAtCentres(const PointImage& points, const Projection& projection);

}  // namespace vdbfuse
