// SPDX-License-Identifier: Apache-2.0
#include "formats/photo_writer.h"

#include <algorithm>
#include <cmath>

#include "formats/image_writer.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

Image<std::uint16_t> sixteenBits(const Image<float>& brightness) {
  Image<std::uint16_t> stored(brightness.width(), brightness.height());
  std::transform(brightness.begin(), brightness.end(), stored.begin(), [](float v) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 65535.0));
  });
  return stored;
}

void writePicture(const fs::path& path, const Photograph& photograph) {
  if (photograph.color.empty()) {
    writePng(path, sixteenBits(photograph.brightness));
  } else {
    writePng(path, photograph.color);
  }
}

}  // namespace

std::vector<std::string> writePictures(const fs::path& folder, const fs::path& pictures,
                                       const PhotographSequence& photographs, const Progress& progress) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < photographs.size(); ++i) names.push_back(photographs.header(i).name);
  names = fileNames(std::move(names));
  createFolder(folder / pictures);
  ProgressStep step(progress, "write", photographs.size());
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    const Photograph photograph = photographs.load(i);
    writePicture(folder / pictures / (names[i] + ".png"), photograph);
    if (!photograph.mask.empty()) {
      createFolder(folder / "masks");
      writePng(folder / "masks" / (names[i] + ".png"), photograph.mask);
    }
    step.advance();
  }
  return names;
}

double onlyFocalLength(const PhotographHeader& header, const std::string& format) {
  constexpr double kTolerance = 1e-9;
  const Pinhole& c = header.camera;
  const double off =
      std::max(std::abs(c.cx - (0.5 * c.width - 0.5)), std::abs(c.cy - (0.5 * c.height - 0.5)));
  if (std::abs(c.fx - c.fy) > kTolerance * c.fx || off > kTolerance * c.width)
    throw InvalidArgument(
        "photograph " + header.name,
        "the format " + format + " holds one focal length and a principal point in the middle only");
  return c.fx;
}

}  // namespace vdbfuse
