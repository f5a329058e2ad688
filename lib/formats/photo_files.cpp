// SPDX-License-Identifier: Apache-2.0
#include "formats/photo_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "formats/frames.h"
#include "formats/masks.h"
#include "io/folder.h"
#include "io/image_size.h"
#include "io/picture.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::array kExtensions = {".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                    ".PNG", ".JPG", ".JPEG", ".TIF"};

struct Counts {
  std::size_t missing = 0, scaled = 0, undistorted = 0, transparent = 0, masked = 0;
};

// The camera for the picture as it is.
void fitToPicture(PhotoFile& file, const io::PictureHeader& picture, Counts& counts) {
  constexpr double kTolerance = 0.02;  // sizes are rounded when pictures are made smaller
  Pinhole& camera = file.lens.camera;
  if (camera.width == 0) camera.width = picture.width, camera.height = picture.height;
  if (file.is_centred) camera.cx = 0.5 * camera.width - 0.5, camera.cy = 0.5 * camera.height - 0.5;
  if (camera.width == picture.width && camera.height == picture.height) return;
  const double sx = static_cast<double>(picture.width) / camera.width,
               sy = static_cast<double>(picture.height) / camera.height;
  if (std::abs(sx / sy - 1) > kTolerance)
    throw IoError(file.picture, "",
                  "a picture of the shape of its camera, " + sizeText(camera.width, camera.height),
                  sizeText(picture.width, picture.height));
  camera = resized(camera, picture.width, picture.height);
  ++counts.scaled;
}

PhotographHeader headerOf(const PhotoFile& file, const Pinhole& camera) {
  PhotographHeader header{file.name, camera, file.world_from_camera, file.depth};
  const bool is_interval = header.depth && header.depth->near > 0 && header.depth->far > header.depth->near &&
                           std::isfinite(header.depth->far);
  if (!is_interval) header.depth.reset();
  return header;
}

void findMasks(const fs::path& input, std::vector<PhotoFile>& files, const ImageReadOptions& options,
               Counts& counts) {
  std::vector<std::string> names;
  for (const PhotoFile& file : files) names.push_back(file.name);
  const fs::path data = fs::is_directory(input) ? input : input.parent_path();
  const std::vector<fs::path> paths = maskPaths(names, data, options.masks);
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!options.masks.empty() || files[i].mask.empty()) files[i].mask = paths[i];
    if (files[i].mask.empty()) continue;
    checkMask(files[i].mask, files[i].lens.camera.width, files[i].lens.camera.height, "picture");
    ++counts.masked;
  }
}

void loadPictures(const PhotoFile& file, Photograph& photograph) {
  io::Picture picture = io::readPictureFile(file.picture);
  const Pinhole& camera = file.lens.camera;
  if (picture.brightness.width() != camera.width || picture.brightness.height() != camera.height)
    throw IoError(file.picture, "", sizeText(camera.width, camera.height) + " pixels as before",
                  sizeText(picture.brightness.width(), picture.brightness.height()));
  photograph.brightness = std::move(picture.brightness);
  photograph.color = std::move(picture.color);
  photograph.mask = file.mask.empty() ? std::move(picture.opaque) : readMask(file.mask);
  if (isDistorted(file.lens)) undistort(photograph, file.lens);
}

void addNotes(std::vector<std::string>& notes, const Counts& counts, std::size_t total) {
  const std::string of_all = " of " + counted(total, "photograph");
  if (counts.missing > 0)
    notes.push_back(counted(counts.missing, "photograph") + " whose picture is missing left out");
  if (counts.scaled > 0)
    notes.push_back(counted(counts.scaled, "camera") +
                    " made for pictures of another size, scaled to the picture");
  if (counts.undistorted > 0)
    notes.push_back("lens distortion taken out of " + std::to_string(counts.undistorted) + of_all);
  if (counts.masked > 0) notes.push_back("silhouette masks for " + std::to_string(counts.masked) + of_all);
  if (counts.transparent > 0)
    notes.push_back("the alpha channel of " + std::to_string(counts.transparent) + of_all +
                    " is the mask where it is not everywhere opaque");
}

}  // namespace

bool hasPictureExtension(const fs::path& path) {
  return std::find(kExtensions.begin(), kExtensions.end(), path.extension().string()) != kExtensions.end();
}

fs::path findPhoto(const fs::path& folder, const std::string& stem) {
  for (const char* extension : kExtensions) {
    fs::path candidate = folder / (stem + extension);
    if (isFile(candidate)) return candidate;
  }
  return {};
}

ImageSet imageSetOf(const fs::path& input, std::vector<PhotoFile> files, const ImageReadOptions& options) {
  if (files.empty()) throw IoError(input, "", "photographs with cameras", "none");
  Counts counts;
  const fs::path first = files.front().picture;
  counts.missing = std::erase_if(files, [](const PhotoFile& file) { return !isFile(file.picture); });
  if (files.empty()) throw IoError(first, "", "a picture", "nothing of that name");
  std::vector<PhotographHeader> headers;
  for (std::size_t i = 0; i < files.size(); ++i) {
    PhotoFile& file = files[i];
    const io::PictureHeader picture = io::readPictureHeader(file.picture);
    fitToPicture(file, picture, counts);
    if (const auto problems = validate(Projection(file.lens.camera)); !problems.empty())
      throw IoError(input, "photograph " + file.name, "a usable camera", problems.front());
    const bool is_as_before = i > 0 && file.lens == files[i - 1].lens;
    headers.push_back(headerOf(file, is_as_before ? headers.back().camera : withoutDistortion(file.lens)));
    counts.undistorted += isDistorted(file.lens) ? 1 : 0;
    file.has_alpha = picture.has_alpha;
  }
  findMasks(input, files, options, counts);
  for (const PhotoFile& file : files) counts.transparent += file.has_alpha && file.mask.empty() ? 1 : 0;
  ImageSet set;
  addNotes(set.notes, counts, files.size());
  const auto shared = std::make_shared<const std::vector<PhotoFile>>(std::move(files));
  set.photographs = PhotographSequence(
      std::move(headers),
      [shared](std::size_t index, Photograph& photograph) { loadPictures((*shared)[index], photograph); });
  return set;
}

}  // namespace vdbfuse
