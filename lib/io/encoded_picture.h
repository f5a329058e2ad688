// SPDX-License-Identifier: Apache-2.0
// Pictures that lie inside another file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::io {

struct EncodedPicture {
  const std::filesystem::path& path;  ///< the file it lies in, for messages
  std::string place;                  ///< where in it; empty: the file is the picture
  std::string_view bytes;
  /// The size it must have; 0: any.
  int width = 0, height = 0;
};

/// Throws IoError, also when the picture ends too early or is of another size.
Image<Rgb8> decodeJpeg(const EncodedPicture& picture);
/// Any kind of PNG; alpha is dropped. Throws IoError.
Image<Rgb8> decodePng(const EncodedPicture& picture);

/// Throws IoError when the size is not that asked for, or beyond reason.
void checkPictureSize(const EncodedPicture& picture, std::int64_t width, std::int64_t height);

/// `place`, or where there is none, the byte behind the picture.
std::string endPlace(const EncodedPicture& picture);

}  // namespace vdbfuse::io
