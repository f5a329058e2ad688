// SPDX-License-Identifier: Apache-2.0
#include "formats/colmap.h"

#include <algorithm>
#include <array>
#include <utility>

#include "formats/colmap_model.h"
#include "formats/frames.h"
#include "formats/photo_files.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

fs::path modelFolder(const fs::path& path) {
  for (const fs::path& folder : {path / "sparse", path / "sparse/0", path}) {
    if (hasColmapModel(folder)) return folder;
  }
  return {};
}

fs::path requireModel(const fs::path& path) {
  fs::path folder = modelFolder(path);
  if (folder.empty())
    throw IoError(path, "", "a model in sparse/ (cameras and images, .bin or .txt)", "none");
  return folder;
}

fs::path depthFolder(const fs::path& path) { return path / "stereo/depth_maps"; }

bool isPicture(const fs::path& path) {
  constexpr std::array kKnown = {".png", ".jpg", ".jpeg", ".JPG", ".JPEG"};
  return std::find(kKnown.begin(), kKnown.end(), path.extension().string()) != kKnown.end() && isFile(path);
}

struct Counts {
  std::size_t photometric = 0, without_depth = 0;
};

// Empty: none.
fs::path depthMapOf(const fs::path& path, const ColmapModel& model, const ColmapImage& image,
                    Counts& counts) {
  for (const char* kind : {".geometric.bin", ".photometric.bin"}) {
    fs::path file = pathInside(depthFolder(path), image.name + kind, model.images_file,
                               "image " + std::to_string(image.id));
    if (!isFile(file)) continue;
    counts.photometric += kind == std::string(".photometric.bin") ? 1 : 0;
    return file;
  }
  ++counts.without_depth;
  return {};
}

std::vector<Frame> framesOf(const fs::path& path, const ColmapModel& model, Counts& counts) {
  std::vector<Frame> frames;
  for (const ColmapImage& image : model.images) {
    Frame frame;
    frame.depth = depthMapOf(path, model, image, counts);
    if (frame.depth.empty()) continue;
    // depthMapOf() checked the name.
    const fs::path picture = path / "images" / image.name;
    if (isPicture(picture)) frame.color = picture;
    frame.header.name = fs::path(image.name).replace_extension().string();
    frame.header.projection = model.cameras.at(image.camera);
    frame.header.world_from_camera = image.camera_from_world.inverse();
    frames.push_back(std::move(frame));
  }
  return frames;
}

void noteMoved(std::vector<std::string>& notes, const ColmapModel& model) {
  if (model.moved > 0)
    notes.push_back(counted(model.moved, "image") +
                    " whose pose in its frame is another than in the list of images; the frame's is taken");
}

void addNotes(DepthSet& set, const ColmapModel& model, const Counts& counts) {
  if (counts.photometric > 0)
    set.notes.push_back(counted(counts.photometric, "photometric depth map") +
                        " in place of a geometric one, which is missing");
  if (counts.without_depth > 0)
    set.notes.push_back(counted(counts.without_depth, "image") + " without a depth map left out");
  noteMoved(set.notes, model);
}

bool holdsMaps(const fs::path& folder) {
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() == ".bin") return true;
  }
  return false;
}

Detection detect(const fs::path& path) {
  using Fit = Detection::Fit;
  const bool has_model = !modelFolder(path).empty(), has_depth = holdsMaps(depthFolder(path));
  if (has_model && has_depth) return {Fit::Fully, "a model and stereo/depth_maps"};
  if (has_depth) return {Fit::Partly, "stereo/depth_maps, but no model in sparse/"};
  if (has_model) return {Fit::Partly, "a model, but no stereo/depth_maps"};
  return {Fit::No, "no sparse/ and no stereo/depth_maps"};
}

// The folder of the pictures; empty: none.
fs::path imageFolder(const fs::path& path) {
  if (fs::is_directory(path / "images")) return path / "images";
  if (!hasColmapModel(path)) return {};
  for (const char* relative : {"../images", "../../images"}) {
    if (fs::is_directory(path / relative)) return path / relative;
  }
  return {};
}

Detection detectImages(const fs::path& path) {
  using Fit = Detection::Fit;
  const bool has_model = !modelFolder(path).empty(), has_images = !imageFolder(path).empty();
  if (has_model && has_images) return {Fit::Fully, "a model and images/"};
  if (has_model) return {Fit::Partly, "a model, but no images/"};
  return {Fit::No, "no model (cameras and images, .bin or .txt)"};
}

}  // namespace

DepthSet readColmap(const fs::path& path, const ReadOptions& options) {
  const fs::path folder = requireModel(path);
  const ColmapModel model = readColmapModel(folder);
  Counts counts;
  std::vector<Frame> frames = framesOf(path, model, counts);
  if (frames.empty())
    throw IoError(depthFolder(path), "", "depth maps of the images (NAME.geometric.bin)", "none");
  FrameFormat format;
  format.pose = "quaternion w x y z and translation, camera_from_world, x right, y down, z forward";
  DepthSet set = setOfFrames(path, std::move(frames), format, options);
  addNotes(set, model, counts);
  return set;
}

DepthSetFormat colmapFormat() {
  return {"colmap",
          "a dense workspace of COLMAP",
          "sparse/ or sparse/0/                     cameras, images (rigs, frames), .bin or .txt\n"
          "stereo/depth_maps/NAME.geometric.bin     z, 0 and negative invalid; NAME has an extension: a.jpg\n"
          "stereo/depth_maps/NAME.photometric.bin   where that is missing\n"
          "images/NAME                              optional\n",
          detect,
          readColmap,
          writeColmap};
}

ImageSet readColmapImages(const fs::path& path, const ImageReadOptions& options) {
  const fs::path folder = requireModel(path), pictures = imageFolder(path);
  if (pictures.empty()) throw IoError(path, "", "the pictures in images/", "no such folder");
  const ColmapModel model = readColmapModel(folder);
  const std::vector<std::optional<DepthInterval>> depths = readColmapDepths(folder, model);
  std::vector<PhotoFile> photos;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    const ColmapImage& image = model.images[i];
    photos.push_back(
        {fs::path(image.name).replace_extension().string(),
         {model.cameras.at(image.camera)},
         image.camera_from_world.inverse(),
         depths[i],
         pathInside(pictures, image.name, model.images_file, "image " + std::to_string(image.id))});
  }
  ImageSet set = imageSetOf(path, std::move(photos), options);
  noteMoved(set.notes, model);
  set.pose = "quaternion w x y z and translation, camera_from_world, x right, y down, z forward";
  return set;
}

ImageSetFormat colmapImageFormat() {
  return {"colmap",
          "photographs with a model of COLMAP",
          "sparse/ or sparse/0/     cameras, images (rigs, frames, points3D), .bin or .txt\n"
          "images/NAME              undistorted where the cameras are not\n",
          detectImages,
          readColmapImages,
          writeColmapImages};
}

}  // namespace vdbfuse
