// SPDX-License-Identifier: Apache-2.0
#include "formats/open3d.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "formats/frames.h"
#include "formats/image_writer.h"
#include "formats/open3d_trajectory.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr std::array kDepthExtensions = {".png", ".exr", ".npy", ".pfm", ".tiff", ".tif"};
constexpr std::array kPictureExtensions = {".png", ".jpg", ".jpeg"};

// The first of `names` that is there, else the only file that ends with `suffix` and holds `part`; none when
// there is none. Throws IoError when there are several.
std::optional<fs::path> findFile(const fs::path& folder, const std::vector<std::string>& names,
                                 const std::string& part, const std::string& suffix) {
  for (const std::string& name : names) {
    if (isFile(folder / name)) return folder / name;
  }
  std::vector<std::string> found = filesEndingWith(folder, suffix);
  std::erase_if(found, [&](const std::string& name) { return name.find(part) == std::string::npos; });
  if (found.empty()) return std::nullopt;
  if (found.size() > 1)
    throw IoError(folder, "", names.front() + " or one *" + part + suffix, found[0] + " and " + found[1]);
  return folder / found.front();
}

std::optional<fs::path> findTrajectory(const fs::path& folder) {
  if (auto log = findFile(folder, {"trajectory.log"}, "", ".log")) return log;
  return findFile(folder, {"trajectory.json"}, "trajectory", ".json");
}

std::optional<fs::path> findIntrinsics(const fs::path& folder) {
  return findFile(folder, {"camera_intrinsic.json", "intrinsic.json", "camera_primesense.json"}, "intrinsic",
                  ".json");
}

bool isLog(const fs::path& path) { return path.extension() == ".log"; }

// Which entry belongs to each depth map; none: the depth map is left out.
std::vector<const TrajectoryEntry*> associate(const fs::path& path,
                                              const std::vector<TrajectoryEntry>& entries,
                                              std::size_t depths) {
  std::vector<const TrajectoryEntry*> result(depths, nullptr);
  const bool is_in_order = entries.size() == depths;
  if (!is_in_order && !isLog(path))
    throw IoError(path, "parameters", counted(depths, "camera") + " as there are depth maps",
                  std::to_string(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::int64_t index = is_in_order ? static_cast<std::int64_t>(i) : entries[i].index.value_or(-1);
    if (index < 0 || static_cast<std::size_t>(index) >= depths)
      throw IoError(path, entries[i].place,
                    "the number of one of " + counted(depths, "depth map") + ", from 0",
                    std::to_string(index));
    const TrajectoryEntry*& place = result[static_cast<std::size_t>(index)];
    if (place != nullptr)
      throw IoError(path, entries[i].place, "one pose for every depth map",
                    "another for number " + std::to_string(index));
    place = &entries[i];
  }
  return result;
}

// Pictures of the depth maps' names, or as many in the same order.
std::vector<fs::path> picturesOf(const fs::path& folder, const std::vector<std::string>& depths) {
  std::vector<fs::path> pictures(depths.size());
  for (const char* name : {"color", "image", "rgb"}) {
    const fs::path colors = folder / name;
    const std::vector<std::string> files = filesInOrder(colors, kPictureExtensions);
    if (files.empty()) continue;
    bool has_same_names = false;
    for (std::size_t i = 0; i < depths.size(); ++i) {
      pictures[i] = findPicture(colors, fs::path(depths[i]).stem().string());
      has_same_names = has_same_names || !pictures[i].empty();
    }
    for (std::size_t i = 0; i < depths.size() && !has_same_names && files.size() == depths.size(); ++i)
      pictures[i] = colors / files[i];
    return pictures;
  }
  return pictures;
}

// `camera` counts before those of the trajectory.
std::vector<Frame> framesOf(const fs::path& path, const std::vector<std::string>& depths,
                            const fs::path& trajectory, const std::optional<Pinhole>& camera) {
  const std::vector<TrajectoryEntry> entries =
      isLog(trajectory) ? readLogTrajectory(trajectory) : readJsonTrajectory(trajectory);
  const std::vector<const TrajectoryEntry*> association = associate(trajectory, entries, depths.size());
  const std::vector<fs::path> pictures = picturesOf(path, depths);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (association[i] == nullptr) continue;
    Frame frame;
    frame.header.name = fs::path(depths[i]).stem().string();
    frame.header.projection = camera ? *camera : association[i]->camera.value_or(Pinhole());
    frame.header.world_from_camera = association[i]->world_from_camera;
    frame.depth = path / "depth" / depths[i];
    frame.color = pictures[i];
    frames.push_back(std::move(frame));
  }
  return frames;
}

Detection detect(const fs::path& path) {
  using Fit = Detection::Fit;
  if (!fs::is_directory(path)) return {Fit::No, "not a folder"};
  const std::size_t depths = filesInOrder(path / "depth", kDepthExtensions).size();
  if (depths == 0) return {Fit::No, "no depth/*.png"};
  try {
    const auto trajectory = findTrajectory(path);
    if (!trajectory) return {Fit::No, "depth/, but no trajectory.log or trajectory.json"};
    if (isLog(*trajectory) && !findIntrinsics(path))
      return {Fit::Partly, "depth/ and a trajectory, but no camera_intrinsic.json"};
    return {Fit::Fully, counted(depths, "depth map") + " and " + trajectory->filename().string()};
  } catch (const Error&) {
    return {Fit::Partly, "depth/, but several trajectories or cameras"};
  }
}

}  // namespace

DepthSet readOpen3d(const fs::path& path, const ReadOptions& options) {
  const std::vector<std::string> depths = filesInOrder(path / "depth", kDepthExtensions);
  if (depths.empty()) throw IoError(path, "", "depth maps (depth/*.png)", "none");
  const auto trajectory = findTrajectory(path), intrinsics = findIntrinsics(path);
  if (!trajectory) throw IoError(path, "", "trajectory.log or trajectory.json", "neither");
  if (isLog(*trajectory) && !intrinsics && !options.intrinsics)
    throw IoError(path, "", "camera_intrinsic.json (or *intrinsic*.json), or --intrinsics", "none");
  std::optional<Pinhole> camera;
  if (options.intrinsics) camera = Pinhole();
  if (intrinsics && !camera) camera = readOpen3dIntrinsic(*intrinsics);
  std::vector<Frame> frames = framesOf(path, depths, *trajectory, camera);
  if (frames.empty()) throw IoError(*trajectory, "", "the pose of a depth map", "none");
  const std::size_t left_out = depths.size() - frames.size();
  FrameFormat format;
  if (!isLog(*trajectory)) format.pose = "4x4 camera_from_world, x right, y down, z forward";
  DepthSet set = setOfFrames(path, std::move(frames), format, options);
  if (left_out > 0) set.notes.push_back(counted(left_out, "depth map") + " without a pose left out");
  return set;
}

void writeOpen3d(const fs::path& folder, const ViewSequence& views, const WriteOptions& options,
                 const Progress& progress) {
  constexpr double kMetresPerMillimetre = 0.001;
  std::vector<TrajectoryEntry> entries;
  bool has_one_camera = true;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewHeader& header = views.header(i);
    entries.push_back({std::nullopt, header.world_from_camera, plainPinhole(header, "open3d"), ""});
    has_one_camera = has_one_camera && entries.back().camera == entries.front().camera;
  }
  createFolder(folder / "depth");
  createFolder(folder / "color");
  std::size_t index = 0;
  forEachView(views, progress, [&](const View& view, const std::string&) {
    const std::string file = numberedName(index++, 6) + ".png";
    writeDepthPng(folder / "depth" / file, view, options.depth_scale.value_or(kMetresPerMillimetre));
    writeColor(folder / "color" / file, view);
  });
  if (!has_one_camera) {
    io::writeFileBytes(folder / "trajectory.json", jsonTrajectoryText(entries));
    return;
  }
  io::writeFileBytes(folder / "trajectory.log", logTrajectoryText(entries));
  io::writeFileBytes(folder / "camera_intrinsic.json", open3dIntrinsicText(*entries.front().camera));
}

DepthSetFormat open3dFormat() {
  return {
      "open3d",
      "sequences of Open3D and of the Redwood data sets",
      "depth/*.png             16-bit grey, millimetres (--depth-scale 0.001); or .exr, .npy, ..., metres\n"
      "color|image|rgb/        optional, PNG or JPEG of the same names, or as many in the same order\n"
      "trajectory.log          blocks \"i j k\" and a 4x4 matrix world_from_camera; or the only *.log\n"
      "trajectory.json         in its place: PinholeCameraTrajectory, camera_from_world, with cameras\n"
      "camera_intrinsic.json   PinholeCameraIntrinsic; or *intrinsic*.json, or --intrinsics fx,fy,cx,cy\n"
      "As many poses as depth maps: in order of their names; else i counts the depth maps from 0\n",
      detect,
      readOpen3d,
      writeOpen3d};
}

}  // namespace vdbfuse
