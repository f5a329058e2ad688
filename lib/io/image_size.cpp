// SPDX-License-Identifier: Apache-2.0
#include "io/image_size.h"

#include "vdbfuse/base/errors.h"

namespace vdbfuse {

void checkImageSize(const std::filesystem::path& path, const std::string& place, std::int64_t width,
                    std::int64_t height) {
  constexpr std::int64_t kMaxPixels = std::int64_t{1} << 28;
  if (width > 0 && height > 0 && width <= kMaxPixels && height <= kMaxPixels / width) return;
  throw IoError(path, place, "an image of 1 to 268435456 pixels", sizeText(width, height));
}

std::string sizeText(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace vdbfuse
