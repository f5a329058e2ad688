// SPDX-License-Identifier: Apache-2.0
// A data set of depth maps with known sensors and poses, read from disk. One pair of files a format; adding
// one is that pair and one line in the table of depth_set.cpp. Formats are told apart by what is in the
// folder or file.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vdbfuse/sensor/depth_buffer.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

struct ReadOptions {
  /// Name of the format; empty: found out by looking.
  std::string format;
  /// A stored number times this is a length (for disparity: pixels; for inverse depth: 1/length). Empty: what
  /// the format says (rgbd: 0.001, mvsnet: 1).
  std::optional<double> depth_scale;
  /// What the stored numbers measure. Empty: what the format says (z for both).
  std::optional<DepthKind> depth_kind;
  /// Distance between the two cameras, for DepthKind::Disparity only, in the unit of the poses.
  std::optional<double> baseline;
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

struct DepthSet {
  ViewSequence views;              ///< never empty
  std::string format;              ///< name of the format it was read as
  std::vector<std::string> notes;  ///< what a person should know: things left out, things corrected
};

/// How well a path fits a format.
struct Detection {
  enum class Fit { No, Partly, Fully };
  Fit fit = Fit::No;
  /// What was found, or what is missing; a short phrase.
  std::string reason;
};

struct DepthSetFormat {
  std::string_view name;
  std::string_view description;
  std::string_view layout;  ///< an example, several lines
  Detection (*detect)(const std::filesystem::path& path);
  DepthSet (*read)(const std::filesystem::path& path, const ReadOptions& options);
};

/// The formats that can be read, in the order in which they are tried.
const std::vector<DepthSetFormat>& depthSetFormats();

/// Reads cameras and poses now, images when they are asked for. Throws InvalidArgument when the options are
/// impossible or name no known format, IoError when the data set is broken or of no known format (then the
/// message says for each format what is missing).
DepthSet readDepthSet(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace vdbfuse
