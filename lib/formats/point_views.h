// SPDX-License-Identifier: Apache-2.0
// Points of laser scanners made into depth maps. Frames: a scanner's own axes are x forward, y left, z up;
// ours are x right, y down, z forward.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/sensor/organised_points.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// camera_from_scanner: x forward, y left, z up to x right, y down, z forward.
RigidTransform cameraFromScanner();

/// Points of one position of a sensor, in its own frame: x right, y down, z forward.
struct PointScan {
  /// One point a pixel where rows and columns are known, non-finite where nothing was measured; empty
  /// otherwise.
  PointImage organised;
  /// Else any number of points in any order.
  std::vector<Eigen::Vector3f> loose;
};

/// The sensor that took a scan, and how it was found.
struct ScanProjection {
  Projection projection;
  enum class Origin {
    Fitted,  ///< the scan's own pixels: every point lies at its row and column
    Splat,   ///< pixels of a spherical image that points are sorted into
  } origin = Origin::Fitted;
};

/// A pinhole or a turning scanner that has the points of an organised scan at their pixels; else a spherical
/// image over all directions that hold points, with `splat_step` (empty: as the points are spaced) between
/// its pixels. Throws InvalidArgument when no point is finite, or the image would have more than 2^26 pixels.
ScanProjection projectionOf(const PointScan& scan, std::optional<double> splat_step);

/// The spherical image for several scans of loose points by one scanner. REQUIRES: there are scans. Throws as
/// above.
ScanProjection projectionOfAll(const std::vector<PointScan>& scans, std::optional<double> splat_step);

/// The depth map: at a fitted projection's pixels, or each pixel the nearest of the points that fall on it,
/// at its own range.
Image<float> depthOf(const PointScan& scan, const ScanProjection& found);

/// Scans of one data set, each read when it is asked for.
struct ScanSource {
  std::vector<ViewHeader> headers;  ///< names and poses; projections are set by setOfScans()
  /// Reads scan `index`. Called from several threads at once. Throws IoError.
  std::function<PointScan(std::size_t index)> load;
  /// OneForAll: loose points of the same scanner, which a few of the scans tell as well as all of them would.
  enum class Sensors { OneEach, OneForAll } sensors = Sensors::OneEach;
  std::string stored = "x y z";  ///< for DepthReading
  std::string invalid = "not finite";
  std::string pose;
  /// DepthSet::stored_from_camera: one a scan, or none.
  std::vector<RigidTransform> stored_from_camera;
};

/// Reads every scan once to find its sensor (of one scanner for all: eight, spread evenly), and again when
/// its depth map is asked for. A note says how many were splatted, and with what step. Throws InvalidArgument
/// for options that points do not have; IoError when a scan holds no point.
DepthSet setOfScans(const std::filesystem::path& input, ScanSource source, const ReadOptions& options,
                    const std::string& format);

}  // namespace vdbfuse
