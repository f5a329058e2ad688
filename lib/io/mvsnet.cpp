// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/mvsnet.h"

#include <algorithm>
#include <memory>

#include "io/folder.h"
#include "io/image_size.h"
#include "io/mvsnet_camera.h"
#include "io/stored_depth.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

constexpr std::string_view kCameraSuffix = "_cam.txt";
constexpr std::string_view kPfmSuffix = ".pfm";

// Where the images of one view lie; empty path: none.
struct Files {
  std::filesystem::path depth, confidence, picture;
};

// Shared by all copies of the sequence.
struct Source {
  std::vector<Files> files;
  std::vector<Projection> projections;
  ReadOptions options;
};

std::vector<std::string> stems(const std::filesystem::path& folder, std::string_view suffix) {
  std::vector<std::string> names = filesEndingWith(folder, suffix);
  for (std::string& name : names) name.resize(name.size() - suffix.size());
  return names;
}

Image<float> readPfmOfSize(const std::filesystem::path& path, const Projection& projection) {
  Image<float> image = readPfm(path);
  const int width = imageWidth(projection), height = imageHeight(projection);
  if (image.width() != width || image.height() != height)
    throw IoError(path, "", sizeText(width, height) + " pixels", sizeText(image.width(), image.height()));
  return image;
}

DepthMap loadView(const Source& source, std::size_t index) {
  const Files& files = source.files[index];
  const Projection& projection = source.projections[index];
  DepthMap map;
  map.depth = sensorDepth(readPfmOfSize(files.depth, projection), projection,
                          encodingFor(source.options, projection, 1.0), source.options);
  if (!files.confidence.empty()) map.confidence = readPfmOfSize(files.confidence, projection);
  if (source.options.color == ReadOptions::Color::Load && !files.picture.empty())
    map.color = readPicture(files.picture);
  return map;
}

Files filesOf(const std::filesystem::path& folder, const std::string& stem) {
  Files files;
  files.depth = folder / "depth_est" / (stem + std::string(kPfmSuffix));
  files.picture = findPicture(folder / "images", stem);
  files.confidence = folder / "confidence" / (stem + std::string(kPfmSuffix));
  if (!std::filesystem::exists(files.confidence)) files.confidence.clear();
  return files;
}

// Only PNG tells its size cheaply; where the picture is a JPEG the powers of two must do.
std::optional<double> depthPerPicture(const Files& files, const PfmHeader& depth_map) {
  if (files.picture.extension() != ".png") return std::nullopt;
  return static_cast<double>(depth_map.width) / readPngHeader(files.picture).width;
}

struct OpenedView {
  ViewHeader header;
  double scale = 1.0;  // of the intrinsics
};

OpenedView openView(const std::filesystem::path& camera_path, const std::string& stem, const Files& files) {
  if (!std::filesystem::exists(camera_path)) {
    throw IoError(camera_path, "", "the camera of depth_est/" + files.depth.filename().string(),
                  "nothing of that name");
  }
  const MvsnetCamera camera = readMvsnetCamera(camera_path);
  const PfmHeader size = readPfmHeader(files.depth);
  if (!files.confidence.empty()) {
    const PfmHeader confidence = readPfmHeader(files.confidence);
    if (confidence.width != size.width || confidence.height != size.height) {
      throw IoError(files.confidence, "", sizeText(size.width, size.height) + " pixels as in the depth map",
                    sizeText(confidence.width, confidence.height));
    }
  }
  const std::optional<FittedCamera> fitted =
      fitToDepthMap(camera.pinhole, size, depthPerPicture(files, size));
  if (!fitted) {
    throw IoError(camera_path, camera.intrinsics_place,
                  "a principal point inside the " + sizeText(size.width, size.height) + " depth map",
                  numberText(camera.pinhole.cx) + ", " + numberText(camera.pinhole.cy));
  }
  return {{stem, fitted->pinhole, camera.world_from_camera}, fitted->scale};
}

void addNote(std::vector<std::string>& notes, std::size_t count, const std::string& noun,
             const std::string& what) {
  if (count > 0) notes.push_back(counted(count, noun) + " " + what);
}

}  // namespace

Detection detectMvsnet(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const std::size_t cameras = filesEndingWith(path / "cams", kCameraSuffix).size();
  const std::size_t depths = filesEndingWith(path / "depth_est", kPfmSuffix).size();
  if (cameras == 0 && depths == 0) return {Detection::Fit::No, "no cams/*_cam.txt and no depth_est/*.pfm"};
  if (cameras == 0) return {Detection::Fit::Partly, "depth_est/*.pfm, but no cams/*_cam.txt"};
  if (depths == 0) return {Detection::Fit::No, "cams/*_cam.txt, but no depth_est/*.pfm"};
  return {Detection::Fit::Fully, counted(depths, "depth map") + " with cameras"};
}

DepthSet readMvsnet(const std::filesystem::path& path, const ReadOptions& options) {
  if (!std::filesystem::is_directory(path)) throw IoError(path, "", "a folder", "a file");
  const std::vector<std::string> names = stems(path / "depth_est", kPfmSuffix);
  if (names.empty()) throw IoError(path, "", "depth maps (depth_est/*.pfm)", "none");
  auto source = std::make_shared<Source>();
  source->options = options;
  std::vector<ViewHeader> headers;
  std::size_t scaled = 0, without_confidence = 0;
  for (const std::string& name : names) {
    source->files.push_back(filesOf(path, name));
    const std::filesystem::path camera_path = path / "cams" / (name + std::string(kCameraSuffix));
    OpenedView view = openView(camera_path, name, source->files.back());
    scaled += view.scale != 1.0 ? 1 : 0;
    without_confidence += source->files.back().confidence.empty() ? 1 : 0;
    source->projections.push_back(view.header.projection);
    headers.push_back(std::move(view.header));
  }
  DepthSet set;
  std::size_t unused = 0;
  for (const std::string& camera : stems(path / "cams", kCameraSuffix))
    unused += std::binary_search(names.begin(), names.end(), camera) ? 0 : 1;
  addNote(set.notes, unused, "camera", "without a depth map left out");
  addNote(set.notes, scaled, "camera", "made for images of another size, scaled to the depth map");
  if (without_confidence < names.size()) addNote(set.notes, without_confidence, "view", "without confidence");
  set.views =
      ViewSequence(std::move(headers), [source](std::size_t index) { return loadView(*source, index); });
  return set;
}

}  // namespace vdbfuse
