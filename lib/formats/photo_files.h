// SPDX-License-Identifier: Apache-2.0
// Photographs whose pictures are files of their own: what all formats of image sets have in common.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/lens.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// One photograph: what its camera files say, and where its picture lies.
struct PhotoFile {
  std::string name;
  /// The size of its pinhole is that of the pictures it was made for, or 0 where the format does not say.
  Lens lens;
  RigidTransform world_from_camera = RigidTransform::Identity();
  std::optional<DepthInterval> depth = std::nullopt;  ///< dropped where it is none
  std::filesystem::path picture;
  std::filesystem::path mask = {};  ///< that the format names; empty: none
  bool is_centred = false;          ///< the principal point is the picture's middle, whatever lens says
  bool has_alpha = false;           ///< set by imageSetOf()
};

/// Whether the extension is one of PNG, JPEG and TIFF.
bool hasPictureExtension(const std::filesystem::path& path);

/// The first of `folder`/`stem` + one of these extensions that exists; empty when none does.
std::filesystem::path findPhoto(const std::filesystem::path& folder, const std::string& stem);

/// Reads the sizes of all pictures now, their pixels when they are asked for, and finds masks. Cameras are
/// brought to the size of their pictures, distortion is taken out; notes say so. `input` is what
/// readImageSet() was given. Photographs whose picture is missing are left out. Throws IoError: no
/// photographs are left, a picture is not of its camera's shape, a camera is unusable.
ImageSet imageSetOf(const std::filesystem::path& input, std::vector<PhotoFile> files,
                    const ImageReadOptions& options);

}  // namespace vdbfuse
