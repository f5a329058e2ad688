// SPDX-License-Identifier: Apache-2.0
// Photographs with known cameras, read from disk: what depth maps are made from. One pair of files a format
// in lib/formats, shared with the reader of depth maps where the format has both; formats are told apart by
// what is in the folder or file.
//
// Where a camera has lens distortion, its photographs are resampled (bilinear) to a pinhole of the same size
// and principal point without distortion, and of the same focal lengths, or longer by what keeps every pixel
// inside the picture. Pixels that even half as long again leave outside are black, and 0 in the mask. Pixel
// centres lie at integers.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {

struct ImageReadOptions {
  /// Name of the format; empty: found out by looking.
  std::string format;
  /// Folder of silhouette masks NAME.png, one for every photograph: any 8-bit PNG of the picture's size,
  /// black where the object is not. Empty: what the format names, else masks/NAME.png or NAME.mask.png in the
  /// data set, else where the picture itself is transparent (opaque by less than half).
  std::filesystem::path masks;
};

struct ImageSet {
  PhotographSequence photographs;  ///< never empty
  std::string format;              ///< name of the format it was read as
  std::string pose;                ///< how poses are stored: "3x3 and 3 camera_from_world, y down, z forward"
  std::vector<std::string> notes;  ///< what a person should know: things left out, things corrected
};

struct ImageWriteOptions {
  /// Of the camera files of formats that have both: colmap.
  enum class Encoding { Text, Binary } encoding = Encoding::Text;
};

struct ImageSetFormat {
  std::string_view name;
  std::string_view description;
  std::string_view layout;  ///< an example, several lines
  Detection (*detect)(const std::filesystem::path& path);
  ImageSet (*read)(const std::filesystem::path& path, const ImageReadOptions& options);
  /// Writes the photographs into an existing empty folder.
  void (*write)(const std::filesystem::path& folder, const PhotographSequence& photographs,
                const ImageWriteOptions& options, const Progress& progress);
};

/// The formats, in the order in which they are tried.
const std::vector<ImageSetFormat>& imageSetFormats();

/// Whether some format fits the path in full.
bool isImageSet(const std::filesystem::path& path);

/// Reads cameras, poses and the sizes of pictures now, pictures when they are asked for. Pictures are PNG,
/// JPEG or TIFF files of 8 or 16 bits, grey or colour. Photographs without a picture, or without a camera,
/// are left out with a note. Throws InvalidArgument when the options name no known format, IoError when the
/// data set is broken or of no known format.
ImageSet readImageSet(const std::filesystem::path& path, const ImageReadOptions& options = {});

/// Writes the photographs in the format of that name into `folder`, which is made and must hold nothing:
/// pictures as PNG, 8-bit colour where there is colour, else 16-bit grey; masks as masks/NAME.png. Depths are
/// kept by mvsnet only. One photograph is in memory at a time. Throws InvalidArgument when the format is
/// unknown or cannot hold a camera (bundler and nvm: one focal length, the principal point in the middle);
/// IoError.
void writeImageSet(const std::filesystem::path& folder, const std::string& format,
                   const PhotographSequence& photographs, const ImageWriteOptions& options = {},
                   const Progress& progress = {});

}  // namespace vdbfuse
