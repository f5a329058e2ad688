// SPDX-License-Identifier: Apache-2.0
#include "formats/transforms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "formats/camera_text.h"
#include "formats/frames.h"
#include "formats/json_fields.h"
#include "formats/photo_files.h"
#include "io/folder.h"
#include "io/picture.h"
#include "io/raster.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr int kLargestSide = 1 << 20;

// What is said for all frames, and what of one.
struct FrameFields {
  JsonField all, frame;

  std::optional<JsonField> find(const std::string& key) const {
    std::optional<JsonField> own = frame.find(key);
    return own ? own : all.find(key);
  }
  double numberOr(const std::string& key, double otherwise) const {
    const std::optional<JsonField> field = find(key);
    return field ? field->number() : otherwise;
  }
};

// Of one file.
struct Context {
  fs::path file, folder;
  const ReadOptions& options;
  std::size_t without_depth = 0, without_picture = 0, masks = 0;
};

std::optional<JsonField> depthField(const JsonField& frame) {
  std::optional<JsonField> field = frame.find("depth_file_path");
  return field ? field : frame.find("depth_path");
}

void checkModel(const FrameFields& fields) {
  constexpr std::array kPerspective = {"OPENCV", "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL"};
  const auto refuse = [](const JsonField& field, const std::string& found) {
    field.fail("a perspective camera (OPENCV, PINHOLE, SIMPLE_PINHOLE, SIMPLE_RADIAL, RADIAL)", found);
  };
  if (const auto model = fields.find("camera_model")) {
    const std::string name = model->text();
    if (std::find(kPerspective.begin(), kPerspective.end(), name) == kPerspective.end())
      refuse(*model, "'" + name.substr(0, 40) + "'");
  }
  for (const char* key : {"is_fisheye", "fisheye", "ftheta", "is_latlong", "orthographic"}) {
    const auto field = fields.find(key);
    if (field && field->truth()) refuse(*field, "true");
  }
  if (const auto k4 = fields.find("k4"); k4 && k4->number() != 0)
    k4->fail("a camera of OpenCV's model, which has no k4", numberText(k4->number()));
}

double focalLength(const FrameFields& fields, const char* key, const char* angle_key, int size,
                   std::optional<double> otherwise) {
  if (const auto field = fields.find(key)) return field->number();
  if (const auto angle = fields.find(angle_key)) return 0.5 * size / std::tan(0.5 * angle->number());
  if (!otherwise) fields.frame.fail("a field '" + std::string(key) + "' or '" + angle_key + "'", "none");
  return *otherwise;
}

enum class Intrinsics { Needed, Given };

// `read_header` gives width and height of the image, where the frame does not say them.
template <class ReadHeader>
Pinhole cameraOf(const FrameFields& fields, const ReadHeader& read_header, Intrinsics intrinsics) {
  checkModel(fields);
  Pinhole camera;
  const auto width = fields.find("w"), height = fields.find("h");
  if (width && height) {
    camera.width = width->whole(1, kLargestSide), camera.height = height->whole(1, kLargestSide);
  } else {
    const auto header = read_header();
    camera.width = header.width, camera.height = header.height;
  }
  if (intrinsics == Intrinsics::Needed) {
    camera.fx = focalLength(fields, "fl_x", "camera_angle_x", camera.width, std::nullopt);
    camera.fy = focalLength(fields, "fl_y", "camera_angle_y", camera.height, camera.fx);
    camera.cx = fields.numberOr("cx", 0.5 * camera.width) - 0.5;
    camera.cy = fields.numberOr("cy", 0.5 * camera.height) - 0.5;
  }
  constexpr std::array kDistortion = {"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < kDistortion.size(); ++i)
    camera.distortion[i] = fields.numberOr(kDistortion[i], 0);
  return camera;
}

RigidTransform poseOf(const fs::path& file, const JsonField& frame) {
  const JsonField field = frame.at("transform_matrix");
  return poseFromMatrix(file, field.place(), field.rows()) * openGlFromCamera();
}

fs::path pictureOf(const Context& context, const JsonField& frame) {
  const auto field = frame.find("file_path");
  if (!field) return {};
  const fs::path path = pathInside(context.folder, field->text(), context.file, field->place());
  if (!path.has_extension()) return findPicture(path.parent_path(), path.filename().string());
  constexpr std::array kKnown = {".png", ".jpg", ".jpeg", ".JPG", ".JPEG"};
  const bool is_known = std::find(kKnown.begin(), kKnown.end(), path.extension().string()) != kKnown.end();
  return is_known && isFile(path) ? path : fs::path();
}

void addFrame(std::vector<Frame>& frames, Context& context, const FrameFields& fields) {
  const auto depth = depthField(fields.frame);
  if (!depth) {
    ++context.without_depth;
    return;
  }
  Frame frame;
  frame.depth = pathInside(context.folder, depth->text(), context.file, depth->place());
  if (!isFile(frame.depth))
    throw IoError(frame.depth, "", "the depth map of " + fields.frame.place(), "nothing of that name");
  frame.color = pictureOf(context, fields.frame);
  frame.header.name = (frame.color.empty() ? frame.depth : frame.color).stem().string();
  frame.header.world_from_camera = poseOf(context.file, fields.frame);
  frame.header.projection = cameraOf(
      fields, [&] { return io::readRasterHeader(frame.depth); },
      context.options.intrinsics ? Intrinsics::Given : Intrinsics::Needed);
  context.without_picture += fields.frame.find("file_path") && frame.color.empty() ? 1 : 0;
  context.masks += fields.frame.find("mask_path") ? 1 : 0;
  frames.push_back(std::move(frame));
}

double scaleOr(const JsonField& root, const std::string& key, double otherwise) {
  const auto field = root.find(key);
  if (!field) return otherwise;
  const double scale = field->number();
  if (!(scale > 0)) field->fail("a number above 0", numberText(scale));
  return scale;
}

FrameFormat formatOf(const JsonField& root) {
  FrameFormat format;
  const double unit = scaleOr(root, "depth_unit_scale_factor", 0);
  format.float_scale = unit > 0 ? unit : 1.0;
  format.integer_scale = scaleOr(root, "integer_depth_scale", unit > 0 ? unit : 0.001);
  format.stored_from_camera = openGlFromCamera();
  format.pose = "4x4 world_from_camera, x right, y up, z backward (OpenGL)";
  return format;
}

void addNotes(DepthSet& set, const Context& context, const JsonField& root) {
  const auto note = [&](std::size_t count, const std::string& noun, const std::string& what) {
    if (count > 0) set.notes.push_back(counted(count, noun) + " " + what);
  };
  note(context.without_depth, "frame", "without a depth map left out");
  note(context.without_picture, "picture", "missing or of another kind than PNG and JPEG");
  note(context.masks, "mask", "of mask_path left out; --masks FOLDER reads them");
  if (root.find("applied_transform") || root.find("applied_scale"))
    set.notes.emplace_back("applied_transform and applied_scale, which the poses contain, are not undone");
}

fs::path fileIn(const fs::path& path) {
  if (!fs::is_directory(path)) return path;
  for (const char* name : {"transforms.json", "transforms_train.json"}) {
    if (isFile(path / name)) return path / name;
  }
  return {};
}

Detection detect(const fs::path& path) {
  using Fit = Detection::Fit;
  const fs::path file = fileIn(path);
  if (file.empty()) return {Fit::No, "no transforms.json"};
  if (file.extension() != ".json") return {Fit::No, "not a folder and no .json file"};
  const bool has_its_name = file.filename().string().starts_with("transforms");
  try {
    const auto frames = JsonField::readFile(file).find("frames");
    std::size_t depths = 0, poses = 0;
    for (std::size_t i = 0; frames && i < frames->size(); ++i) {
      depths += depthField((*frames)[i]) ? 1 : 0;
      poses += (*frames)[i].find("transform_matrix") ? 1 : 0;
    }
    if (depths > 0 && poses > 0)
      return {Fit::Fully, counted(depths, "depth map") + " named in " + file.filename().string()};
    if (poses > 0) return {Fit::Partly, "frames without a depth map (depth_file_path)"};
  } catch (const Error&) {
    if (has_its_name) return {Fit::Partly, "a broken transforms.json"};
  }
  return {has_its_name ? Fit::Partly : Fit::No, "no frames with a transform_matrix"};
}

// Of one frame; its picture is empty where there is none.
PhotoFile photoOf(const fs::path& file, const FrameFields& fields) {
  PhotoFile photo;
  const auto stated = fields.frame.find("file_path");
  if (!stated) return {};
  photo.picture = pathInside(file.parent_path(), stated->text(), file, stated->place());
  if (!hasPictureExtension(photo.picture))
    photo.picture = findPhoto(photo.picture.parent_path(), photo.picture.filename().string());
  if (!isFile(photo.picture)) return {};
  photo.name = photo.picture.stem().string();
  photo.world_from_camera = poseOf(file, fields.frame);
  photo.lens.camera = cameraOf(
      fields, [&] { return io::readPictureHeader(photo.picture); }, Intrinsics::Needed);
  if (const auto mask = fields.frame.find("mask_path"))
    photo.mask = pathInside(file.parent_path(), mask->text(), file, mask->place());
  return photo;
}

Detection detectImages(const fs::path& path) {
  using Fit = Detection::Fit;
  const Detection found = detect(path);
  if (found.fit == Fit::No) return found;
  try {
    const fs::path file = fileIn(path);
    const JsonField root = JsonField::readFile(file), list = root.at("frames");
    std::size_t pictures = 0;
    for (std::size_t i = 0; i < list.size(); ++i) pictures += list[i].find("file_path") ? 1 : 0;
    if (pictures > 0 && list[0].find("transform_matrix"))
      return {Fit::Fully, counted(pictures, "picture") + " named in " + file.filename().string()};
  } catch (const Error&) {
    return {Fit::Partly, "a broken transforms.json"};
  }
  return {Fit::Partly, "no frames with file_path and transform_matrix"};
}

}  // namespace

DepthSet readTransforms(const fs::path& path, const ReadOptions& options) {
  Context context{fileIn(path), {}, options};
  if (context.file.empty()) throw IoError(path, "", "transforms.json", "nothing of that name");
  context.folder = context.file.parent_path();
  const JsonField root = JsonField::readFile(context.file), list = root.at("frames");
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < list.size(); ++i) addFrame(frames, context, {root, list[i]});
  if (frames.empty())
    throw IoError(context.file, "frames", "a frame with depth_file_path or depth_path", "none");
  DepthSet set = setOfFrames(context.file, std::move(frames), formatOf(root), options);
  addNotes(set, context, root);
  return set;
}

ImageSet readTransformsImages(const fs::path& path, const ImageReadOptions& options) {
  const fs::path file = fileIn(path);
  if (file.empty()) throw IoError(path, "", "transforms.json", "nothing of that name");
  const JsonField root = JsonField::readFile(file), list = root.at("frames");
  std::vector<PhotoFile> photos;
  for (std::size_t i = 0; i < list.size(); ++i) {
    PhotoFile photo = photoOf(file, {root, list[i]});
    if (!photo.picture.empty()) photos.push_back(std::move(photo));
  }
  if (photos.empty()) throw IoError(file, "frames", "a frame with a picture (file_path)", "none");
  const std::size_t missing = list.size() - photos.size();
  ImageSet set = imageSetOf(file, std::move(photos), options);
  if (missing > 0) set.notes.push_back(counted(missing, "photograph") + " whose picture is missing left out");
  set.pose = "4x4 world_from_camera, x right, y up, z backward (OpenGL)";
  return set;
}

DepthSetFormat transformsFormat() {
  return {
      "transforms",
      "transforms.json of nerfstudio and instant-ngp, with depth maps",
      "transforms.json       fl_x, fl_y, cx, cy, w, h (or camera_angle_x), k1, k2, p1, p2, k3; centres at "
      ".5\n"
      "  frames[].transform_matrix    4x4 world_from_camera, camera x right, y up, z backward\n"
      "  frames[].depth_file_path     or depth_path: PNG, EXR, NPY, ...; z\n"
      "  frames[].file_path           the picture, optional\n"
      "  depth_unit_scale_factor, integer_depth_scale   unit of the depth maps; else whole numbers 0.001,\n"
      "                                                 floats 1\n",
      detect,
      readTransforms,
      writeTransforms};
}

ImageSetFormat transformsImageFormat() {
  return {"transforms",
          "photographs of transforms.json of nerfstudio and instant-ngp",
          "transforms.json       fl_x, fl_y, cx, cy, w, h (or camera_angle_x), k1, k2, p1, p2, k3; centres "
          "at .5\n"
          "  frames[].transform_matrix    4x4 world_from_camera, camera x right, y up, z backward\n"
          "  frames[].file_path           the picture; its extension may be missing\n"
          "  frames[].mask_path           optional, black where the object is not\n",
          detectImages,
          readTransformsImages,
          writeTransformsImages};
}

}  // namespace vdbfuse
