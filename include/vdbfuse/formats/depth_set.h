// SPDX-License-Identifier: Apache-2.0
// A data set of depth maps with known sensors and poses, read from disk. One pair of files a format in
// lib/formats; adding one is that pair and one line in the table of depth_set.cpp. Formats are told apart by
// what is in the folder or file.
#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/sensor/depth_buffer.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

struct ReadOptions {
  /// Name of the format; empty: found out by looking.
  std::string format;
  /// A stored number times this is a length (for disparity: pixels; for inverse depth: 1/length; for points:
  /// x, y and z). Empty: what the format says.
  std::optional<double> depth_scale;
  /// What the stored numbers measure. Empty: what the format says. Formats of points have none.
  std::optional<DepthKind> depth_kind;
  /// Distance between the two cameras, for DepthKind::Disparity only, in the unit of the poses.
  std::optional<double> baseline;
  /// fx, fy, cx, cy of the depth camera, pixels of the depth map with centres at integers, in place of what
  /// the data set says or lacks. For cameras only.
  std::optional<std::array<double, 4>> intrinsics;
  /// Angle between neighbouring pixels of the spherical depth maps that points without rows and columns are
  /// made into, radians. Empty: as the points are spaced.
  std::optional<double> splat_step;
  /// Depths outside [min_depth, max_depth], in the sensor's measure and the unit of the poses, become
  /// invalid.
  double min_depth = 0.0;
  double max_depth = std::numeric_limits<double>::infinity();
  /// Folder of silhouette masks NAME.png, one for every view: any 8-bit PNG of the depth map's size, black
  /// where the object is not. Empty: masks/NAME.png or NAME.mask.png in the data set, for the views that have
  /// one.
  std::filesystem::path masks;
  enum class Color { Load, Skip };
  /// Skip saves the time to decode the pictures.
  Color color = Color::Load;
};

/// Everything that is wrong with the options, one sentence each.
std::vector<std::string> validate(const ReadOptions& options);

/// How a reader understands the numbers on disk, with what the options changed.
struct DepthReading {
  std::string stored;             ///< "16-bit PNG", "x y z as 4-byte floats"
  std::optional<DepthKind> kind;  ///< none: points
  double scale = 1.0;             ///< ReadOptions::depth_scale
  std::string invalid;            ///< which numbers mean "nothing measured": "0 and 65535"
  std::string pose;               ///< "4x4 world_from_camera, x right, y down, z forward"
};

struct DepthSet {
  ViewSequence views;    ///< never empty
  std::string format;    ///< name of the format it was read as
  DepthReading reading;  ///< what was taken for granted
  /// Of each view: the frame that the pose on disk speaks of, from the camera's (scanners with z up, OpenGL's
  /// axes). Empty: the camera's own.
  std::vector<RigidTransform> stored_from_camera;
  std::vector<std::string> notes;  ///< what a person should know: things left out, things corrected
};

/// How well a path fits a format.
struct Detection {
  enum class Fit { No, Partly, Fully };
  Fit fit = Fit::No;
  /// What was found, or what is missing; a short phrase.
  std::string reason;
};

struct WriteOptions {
  /// Length of one step of formats that store whole numbers. Empty: what the format's other readers expect
  /// (0.001, tum 0.0002).
  std::optional<double> depth_scale;
};

struct DepthSetFormat {
  std::string_view name;
  std::string_view description;
  std::string_view layout;  ///< an example, several lines
  Detection (*detect)(const std::filesystem::path& path);
  DepthSet (*read)(const std::filesystem::path& path, const ReadOptions& options);
  /// Writes the views into an existing empty folder. Null: this format is read only.
  void (*write)(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions& options,
                const Progress& progress) = nullptr;
};

/// The formats that can be read, in the order in which they are tried.
const std::vector<DepthSetFormat>& depthSetFormats();

/// Reads cameras and poses now, images when they are asked for. Throws InvalidArgument when the options are
/// impossible or name no known format, IoError when the data set is broken or of no known format (then the
/// message says for each format what is missing).
DepthSet readDepthSet(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes the views in the format of that name into `folder`, which is made and must hold nothing. One view
/// is in memory at a time. Silhouette masks are not written: what they leave out is invalid. Throws
/// InvalidArgument when the format is unknown or read only, or a view is not of its kind (most hold pinholes
/// only), or a depth does not fit into its whole numbers; IoError.
void writeDepthSet(const std::filesystem::path& folder, const std::string& format, const ViewSequence& views,
                   const WriteOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
