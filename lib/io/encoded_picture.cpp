// SPDX-License-Identifier: Apache-2.0
#include "io/encoded_picture.h"

#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {

void checkPictureSize(const EncodedPicture& picture, std::int64_t width, std::int64_t height) {
  checkImageSize(picture.path, picture.place, width, height);
  if (picture.width == 0 || (width == picture.width && height == picture.height)) return;
  throw IoError(picture.path, picture.place,
                "a picture of " + sizeText(picture.width, picture.height) + " pixels",
                sizeText(width, height));
}

std::string endPlace(const EncodedPicture& picture) {
  return picture.place.empty() ? "byte " + std::to_string(picture.bytes.size()) : picture.place;
}

}  // namespace vdbfuse::io
