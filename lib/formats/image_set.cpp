// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/formats/image_set.h"

#include "formats/bundler.h"
#include "formats/colmap.h"
#include "formats/format_table.h"
#include "formats/middlebury.h"
#include "formats/mvsnet_format.h"
#include "formats/nvm.h"
#include "formats/strecha.h"
#include "formats/transforms.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {

const std::vector<ImageSetFormat>& imageSetFormats() {
  static const std::vector<ImageSetFormat> formats = {
      middleburyImageFormat(), mvsnetImageFormat(),  transformsImageFormat(), colmapImageFormat(),
      strechaImageFormat(),    bundlerImageFormat(), nvmImageFormat()};
  return formats;
}

bool isImageSet(const std::filesystem::path& path) {
  for (const ImageSetFormat& format : imageSetFormats()) {
    if (format.detect(path).fit == Detection::Fit::Fully) return true;
  }
  return false;
}

ImageSet readImageSet(const std::filesystem::path& path, const ImageReadOptions& options) {
  if (!std::filesystem::exists(path)) throw IoError(path, "", "a set of photographs", "nothing of that name");
  const ImageSetFormat& format = options.format.empty()
                                     ? bestFormat(imageSetFormats(), path, "a set of photographs")
                                     : formatNamed(imageSetFormats(), options.format);
  ImageSet set = format.read(path, options);
  set.format = format.name;
  return set;
}

void writeImageSet(const std::filesystem::path& folder, const std::string& format,
                   const PhotographSequence& photographs, const ImageWriteOptions& options,
                   const Progress& progress) {
  const ImageSetFormat& target = formatNamed(imageSetFormats(), format);
  if (photographs.empty())
    throw InvalidArgument("photographs", "expected at least one photograph, found none");
  requireEmptyFolder(folder);
  target.write(folder, photographs, options, progress);
}

}  // namespace vdbfuse
