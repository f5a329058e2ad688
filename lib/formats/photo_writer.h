// SPDX-License-Identifier: Apache-2.0
// What writers of image sets have in common.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// Writes the picture of every photograph as `folder`/`pictures`/NAME.png (an empty `pictures`: beside the
/// camera files), and its mask as `folder`/masks/NAME.png. Returns the NAMEs: the photographs' own, or
/// numbers where these cannot all be file names. One photograph is in memory at a time.
std::vector<std::string> writePictures(const std::filesystem::path& folder,
                                       const std::filesystem::path& pictures,
                                       const PhotographSequence& photographs, const Progress& progress);

/// The focal length of a camera that has one, and its principal point in the middle. Throws InvalidArgument;
/// `format` names what can hold no other.
double onlyFocalLength(const PhotographHeader& header, const std::string& format);

}  // namespace vdbfuse
