// SPDX-License-Identifier: Apache-2.0
#include "formats/mvsnet_format.h"

#include <algorithm>

#include "formats/frames.h"
#include "formats/image_writer.h"
#include "formats/mvsnet_camera.h"
#include "formats/photo_files.h"
#include "formats/photo_writer.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/image_size.h"
#include "io/picture.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

constexpr std::string_view kCameraSuffix = "_cam.txt";
constexpr std::string_view kPfmSuffix = ".pfm";

std::vector<std::string> stems(const std::filesystem::path& folder, std::string_view suffix) {
  std::vector<std::string> names = filesEndingWith(folder, suffix);
  for (std::string& name : names) name.resize(name.size() - suffix.size());
  return names;
}

Frame frameOf(const std::filesystem::path& folder, const std::string& stem) {
  Frame frame;
  frame.header.name = stem;
  frame.depth = folder / "depth_est" / (stem + std::string(kPfmSuffix));
  frame.color = findPicture(folder / "images", stem);
  frame.confidence = folder / "confidence" / (stem + std::string(kPfmSuffix));
  if (!std::filesystem::exists(frame.confidence)) frame.confidence.clear();
  return frame;
}

// Only PNG tells its size cheaply; where the picture is a JPEG the powers of two must do.
std::optional<double> depthPerPicture(const Frame& frame, const PfmHeader& depth_map) {
  if (frame.color.extension() != ".png") return std::nullopt;
  return static_cast<double>(depth_map.width) / readPngHeader(frame.color).width;
}

// Sets pose and camera; returns what the intrinsics were multiplied by.
double addCamera(const std::filesystem::path& camera_path, Frame& frame) {
  if (!std::filesystem::exists(camera_path)) {
    throw IoError(camera_path, "", "the camera of depth_est/" + frame.depth.filename().string(),
                  "nothing of that name");
  }
  const MvsnetCamera camera = readMvsnetCamera(camera_path);
  const PfmHeader size = readPfmHeader(frame.depth);
  const std::optional<FittedCamera> fitted =
      fitToDepthMap(camera.pinhole, size, depthPerPicture(frame, size));
  if (!fitted) {
    throw IoError(camera_path, camera.intrinsics_place,
                  "a principal point inside the " + sizeText(size.width, size.height) + " depth map",
                  numberText(camera.pinhole.cx) + ", " + numberText(camera.pinhole.cy));
  }
  frame.header.projection = fitted->pinhole;
  frame.header.world_from_camera = camera.world_from_camera;
  return fitted->scale;
}

void addNote(std::vector<std::string>& notes, std::size_t count, const std::string& noun,
             const std::string& what) {
  if (count > 0) notes.push_back(counted(count, noun) + " " + what);
}

Detection detect(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const std::size_t cameras = filesEndingWith(path / "cams", kCameraSuffix).size();
  const std::size_t depths = filesEndingWith(path / "depth_est", kPfmSuffix).size();
  if (cameras == 0 && depths == 0) return {Detection::Fit::No, "no cams/*_cam.txt and no depth_est/*.pfm"};
  if (cameras == 0) return {Detection::Fit::Partly, "depth_est/*.pfm, but no cams/*_cam.txt"};
  if (depths == 0) return {Detection::Fit::No, "cams/*_cam.txt, but no depth_est/*.pfm"};
  return {Detection::Fit::Fully, counted(depths, "depth map") + " with cameras"};
}

Detection detectImages(const std::filesystem::path& path) {
  using Fit = Detection::Fit;
  const std::vector<std::string> cameras = stems(path / "cams", kCameraSuffix);
  if (cameras.empty()) return {Fit::No, "no cams/*_cam.txt"};
  const bool has_picture = std::any_of(cameras.begin(), cameras.end(), [&](const std::string& name) {
    return !findPhoto(path / "images", name).empty();
  });
  if (!has_picture) return {Fit::Partly, "cams/*_cam.txt, but no pictures of these names in images/"};
  return {Fit::Fully, counted(cameras.size(), "camera") + " and images/"};
}

// Sets the camera; returns whether it was scaled.
bool addCamera(const std::filesystem::path& camera_path, PhotoFile& photo) {
  const MvsnetCamera camera = readMvsnetCamera(camera_path);
  const io::PictureHeader size = io::readPictureHeader(photo.picture);
  const std::optional<FittedCamera> fitted =
      fitToDepthMap(camera.pinhole, {size.width, size.height}, std::nullopt);
  if (!fitted) {
    throw IoError(camera_path, camera.intrinsics_place,
                  "a principal point inside the " + sizeText(size.width, size.height) + " picture",
                  numberText(camera.pinhole.cx) + ", " + numberText(camera.pinhole.cy));
  }
  photo.lens.camera = fitted->pinhole;
  photo.world_from_camera = camera.world_from_camera;
  photo.depth = camera.depths;
  return fitted->scale != 1.0;
}

void write(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions&,
           const Progress& progress) {
  MvsnetWriter writer(folder);
  forEachView(views, progress, [&](const View& view, const std::string&) { writer.add(view); });
}

}  // namespace

DepthSet readMvsnet(const std::filesystem::path& path, const ReadOptions& options) {
  if (!std::filesystem::is_directory(path)) throw IoError(path, "", "a folder", "a file");
  const std::vector<std::string> names = stems(path / "depth_est", kPfmSuffix);
  if (names.empty()) throw IoError(path, "", "depth maps (depth_est/*.pfm)", "none");
  std::vector<Frame> frames;
  std::size_t scaled = 0, without_confidence = 0;
  for (const std::string& name : names) {
    Frame frame = frameOf(path, name);
    scaled += addCamera(path / "cams" / (name + std::string(kCameraSuffix)), frame) != 1.0 ? 1 : 0;
    without_confidence += frame.confidence.empty() ? 1 : 0;
    frames.push_back(std::move(frame));
  }
  FrameFormat format;
  format.pose = "4x4 camera_from_world ('extrinsic'), x right, y down, z forward";
  DepthSet set = setOfFrames(path, std::move(frames), format, options);
  std::size_t unused = 0;
  for (const std::string& camera : stems(path / "cams", kCameraSuffix))
    unused += std::binary_search(names.begin(), names.end(), camera) ? 0 : 1;
  addNote(set.notes, unused, "camera", "without a depth map left out");
  addNote(set.notes, scaled, "camera", "made for images of another size, scaled to the depth map");
  if (without_confidence < names.size()) addNote(set.notes, without_confidence, "view", "without confidence");
  return set;
}

DepthSetFormat mvsnetFormat() {
  return {"mvsnet",
          "depth maps of multi-view stereo in the folders of MVSNet",
          "cams/00000000_cam.txt     'extrinsic' 4x4 camera_from_world, 'intrinsic' 3x3, smallest depth and "
          "interval\n"
          "depth_est/00000000.pfm    z, 0 invalid\n"
          "confidence/00000000.pfm   optional\n"
          "images/00000000.png|jpg   optional\n"
          "masks/00000000.png        optional, 8 bit, black where the object is not\n",
          detect,
          readMvsnet,
          write};
}

ImageSet readMvsnetImages(const std::filesystem::path& path, const ImageReadOptions& options) {
  const std::vector<std::string> names = stems(path / "cams", kCameraSuffix);
  if (names.empty()) throw IoError(path, "", "cameras (cams/*_cam.txt)", "none");
  std::vector<PhotoFile> photos;
  std::size_t scaled = 0;
  for (const std::string& name : names) {
    PhotoFile photo;
    photo.name = name;
    photo.picture = findPhoto(path / "images", name);
    if (photo.picture.empty()) continue;
    scaled += addCamera(path / "cams" / (name + std::string(kCameraSuffix)), photo) ? 1 : 0;
    photos.push_back(std::move(photo));
  }
  if (photos.empty()) throw IoError(path / "images", "", "pictures of the cameras in cams/", "none");
  const std::size_t unused = names.size() - photos.size();
  ImageSet set = imageSetOf(path, std::move(photos), options);
  addNote(set.notes, unused, "camera", "without a picture left out");
  addNote(set.notes, scaled, "camera", "made for images of another size, scaled to the picture");
  set.pose = "4x4 camera_from_world ('extrinsic'), x right, y down, z forward";
  return set;
}

void writeMvsnetImages(const std::filesystem::path& folder, const PhotographSequence& photographs,
                       const ImageWriteOptions&, const Progress& progress) {
  createFolder(folder / "cams");
  const std::vector<std::string> names = writePictures(folder, "images", photographs, progress);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const PhotographHeader& header = photographs.header(i);
    const DepthInterval depths = header.depth.value_or(DepthInterval{});
    io::writeFileBytes(folder / "cams" / (names[i] + std::string(kCameraSuffix)),
                       mvsnetCameraText(header.camera, header.world_from_camera, depths.near, depths.far));
  }
}

ImageSetFormat mvsnetImageFormat() {
  return {"mvsnet",
          "photographs with cameras in the folders of MVSNet",
          "cams/00000000_cam.txt     'extrinsic' 4x4 camera_from_world, 'intrinsic' 3x3, depths\n"
          "images/00000000.png|jpg   may be larger than the cameras were made for\n",
          detectImages,
          readMvsnetImages,
          writeMvsnetImages};
}

}  // namespace vdbfuse
