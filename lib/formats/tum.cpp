// SPDX-License-Identifier: Apache-2.0
#include "formats/tum.h"

#include <algorithm>
#include <cmath>

#include "formats/camera_text.h"
#include "formats/frames.h"
#include "formats/image_writer.h"
#include "formats/trajectory.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
constexpr double kStep = 1.0 / 5000;
// What the benchmark's own associate.py takes for simultaneous, seconds.
constexpr double kSimultaneous = 0.02;
constexpr const char* kAssociations[] = {"associations.txt", "associate.txt", "association.txt"};

struct StampedFile {
  double time = 0;
  fs::path path;
  std::string stamp;  // as it is written
};

fs::path existing(const fs::path& folder, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (fs::is_regular_file(folder / name)) return folder / name;
  }
  return {};
}

fs::path associationsOf(const fs::path& folder) {
  return existing(folder, {kAssociations[0], kAssociations[1], kAssociations[2]});
}

// The trajectory of ICL-NUIM is called after its scene.
fs::path trajectoryOf(const fs::path& folder) {
  const fs::path usual = existing(folder, {"groundtruth.txt", "trajectory.txt"});
  if (!usual.empty()) return usual;
  const std::vector<std::string> others = filesEndingWith(folder, ".freiburg");
  return others.size() == 1 ? folder / others.front() : fs::path();
}

bool isIclNuim(const fs::path& trajectory) { return trajectory.extension() == ".freiburg"; }

StampedFile stampedFile(const fs::path& listing, const TextLine& line, std::size_t first) {
  const std::string place = "line " + std::to_string(line.number);
  return {finiteNumber(listing, line, line.words[first]),
          pathInside(listing.parent_path(), line.words[first + 1], listing, place), line.words[first]};
}

std::vector<StampedFile> readFiles(const fs::path& listing) {
  std::vector<StampedFile> files;
  for (const TextLine& line : readListing(listing)) {
    if (line.words.size() != 2)
      throw IoError(listing, "line " + std::to_string(line.number), "time and file name",
                    std::to_string(line.words.size()) + " words");
    files.push_back(stampedFile(listing, line, 0));
  }
  std::stable_sort(files.begin(), files.end(),
                   [](const StampedFile& a, const StampedFile& b) { return a.time < b.time; });
  return files;
}

struct Images {
  std::vector<StampedFile> depth;
  std::vector<fs::path> color;  // one each, may be empty
};

const StampedFile* nearest(const std::vector<StampedFile>& files, double time) {
  const StampedFile* best = nullptr;
  const auto after = std::lower_bound(files.begin(), files.end(), time,
                                      [](const StampedFile& f, double t) { return f.time < t; });
  if (after != files.end()) best = &*after;
  if (after != files.begin() && (best == nullptr || time - std::prev(after)->time < best->time - time))
    best = &*std::prev(after);
  return best != nullptr && std::abs(best->time - time) <= kSimultaneous ? best : nullptr;
}

Images imagesOfLists(const fs::path& folder) {
  Images images;
  images.depth = readFiles(folder / "depth.txt");
  const fs::path rgb = existing(folder, {"rgb.txt"});
  const std::vector<StampedFile> pictures = rgb.empty() ? std::vector<StampedFile>() : readFiles(rgb);
  for (const StampedFile& depth : images.depth) {
    const StampedFile* picture = nearest(pictures, depth.time);
    images.color.push_back(picture == nullptr ? fs::path() : picture->path);
  }
  return images;
}

Images imagesOfAssociations(const fs::path& listing) {
  Images images;
  for (const TextLine& line : readListing(listing)) {
    if (line.words.size() != 4)
      throw IoError(listing, "line " + std::to_string(line.number), "time, file, time and file",
                    std::to_string(line.words.size()) + " words");
    const bool depth_first = line.words[1].find("depth") != std::string::npos;
    images.depth.push_back(stampedFile(listing, line, depth_first ? 0 : 2));
    images.color.push_back(stampedFile(listing, line, depth_first ? 2 : 0).path);
  }
  return images;
}

Pinhole cameraOf(const fs::path& path) {
  const std::vector<TextLine> lines = readListing(path);
  if (lines.size() >= 3)
    return pinholeFromMatrix(path, linePlace(lines, 0),
                             readMatrix(path, lines, 0, 3, 3, "a 3x3 matrix of intrinsics"), 0, 0);
  const Eigen::MatrixXd v = readMatrix(path, lines, 0, 1, 4, "fx fy cx cy, or a 3x3 matrix");
  return {0, 0, v(0, 0), v(0, 1), v(0, 2), v(0, 3), {}};
}

Pinhole cameraFor(const fs::path& folder, const fs::path& trajectory, const ReadOptions& options,
                  std::vector<std::string>& notes) {
  std::vector<std::string> files = filesEndingWith(folder, ".txt");
  std::erase_if(files, [](const std::string& f) { return f.find("intrinsics") == std::string::npos; });
  if (options.intrinsics) return {};
  if (!files.empty()) return cameraOf(folder / files.front());
  const bool icl = isIclNuim(trajectory);
  notes.push_back(std::string("no *intrinsics*.txt; taken are those that the authors of ") +
                  (icl ? "ICL-NUIM recommend: 481.2, -480, 319.5, 239.5"
                       : "the TUM benchmark recommend: 525, 525, 319.5, 239.5") +
                  " (--intrinsics)");
  return icl ? Pinhole{640, 480, 481.2, -480, 319.5, 239.5, {}}
             : Pinhole{640, 480, 525, 525, 319.5, 239.5, {}};
}

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  if (existing(path, {"depth.txt"}).empty() && associationsOf(path).empty())
    return {Detection::Fit::No, "no depth.txt and no associations.txt"};
  if (trajectoryOf(path).empty())
    return {Detection::Fit::Partly, "depth.txt or associations.txt, but no groundtruth.txt"};
  return {Detection::Fit::Fully, "a list of images and a trajectory"};
}

DepthSet read(const fs::path& path, const ReadOptions& options) {
  const fs::path trajectory_path = trajectoryOf(path);
  if (trajectory_path.empty())
    throw IoError(path, "", "a trajectory (groundtruth.txt or one *.freiburg)", "none");
  const fs::path associations = associationsOf(path);
  const Images images = existing(path, {"depth.txt"}).empty() && !associations.empty()
                            ? imagesOfAssociations(associations)
                            : imagesOfLists(path);
  const std::vector<StampedPose> trajectory = readTrajectory(trajectory_path);
  std::vector<std::string> notes;
  const Pinhole camera = cameraFor(path, trajectory_path, options, notes);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < images.depth.size(); ++i) {
    const auto pose = poseAt(trajectory, images.depth[i].time, kSimultaneous);
    if (!pose) continue;
    Frame frame;
    frame.header = {images.depth[i].path.stem().string(), camera, *pose};
    makeRightHanded(frame.header);
    frame.depth = images.depth[i].path;
    frame.color = images.color[i];
    if (!frame.color.empty() && !fs::exists(frame.color)) frame.color.clear();
    frames.push_back(std::move(frame));
  }
  if (frames.empty()) throw IoError(trajectory_path, "", "a pose within 0.02 s of a depth map", "none");
  if (frames.size() < images.depth.size())
    notes.push_back(counted(images.depth.size() - frames.size(), "depth map") +
                    " without a pose within 0.02 s left out");
  if (camera.fy < 0)
    notes.emplace_back("left-handed camera (fy below 0): the y axes of camera and world turned round");
  FrameFormat format;
  format.integer_scale = kStep;
  format.pose = "quaternion x y z w, world_from_camera, x right, y down, z forward";
  DepthSet set = setOfFrames(path, std::move(frames), format, options);
  set.notes.insert(set.notes.begin(), notes.begin(), notes.end());
  return set;
}

// Names are times where they can be; else frames are 1/30 s apart.
std::string stampOf(const std::string& name, std::size_t index) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", static_cast<double>(index) / 30);
  const bool is_time = name.find_first_not_of("0123456789.") == name.npos && name.find('.') != name.npos &&
                       name.find('.') == name.rfind('.') && name.front() != '.';
  return is_time ? name : text;
}

void write(const fs::path& folder, const ViewSequence& views, const WriteOptions& options,
           const Progress& progress) {
  const Pinhole camera = commonPinhole(views, "tum");
  createFolder(folder / "depth");
  std::string depths, pictures, poses;
  std::size_t index = 0;
  forEachView(views, progress, [&](const View& view, const std::string& name) {
    const std::string stamp = stampOf(name, index++), file = name + ".png";
    writeDepthPng(folder / "depth" / file, view, options.depth_scale.value_or(kStep));
    depths += stamp + " depth/" + file + "\n";
    poses += trajectoryLine(stamp, view.world_from_camera);
    if (view.map.color.empty() || view.color_sensor) return;
    createFolder(folder / "rgb");
    writeColor(folder / "rgb" / file, view);
    pictures += stamp + " rgb/" + file + "\n";
  });
  io::writeFileBytes(folder / "intrinsics.txt", matrixText(intrinsicMatrix(camera)));
  if (!pictures.empty()) io::writeFileBytes(folder / "rgb.txt", "# time file\n" + pictures);
  io::writeFileBytes(folder / "depth.txt", "# time file\n" + depths);
  io::writeFileBytes(folder / "groundtruth.txt", "# time tx ty tz qx qy qz qw\n" + poses);
}

}  // namespace

DepthSetFormat tumFormat() {
  return {"tum",
          "sequences of the TUM RGB-D benchmark and of ICL-NUIM",
          "depth.txt              'time depth/NAME.png' a line; or associations.txt with depth and rgb\n"
          "rgb.txt                optional, 'time rgb/NAME.png'\n"
          "groundtruth.txt        'time tx ty tz qx qy qz qw', world_from_camera; or one *.freiburg\n"
          "*intrinsics*.txt       optional: fx fy cx cy, or 3x3; without it 525,525,319.5,239.5 (TUM) or\n"
          "                       481.2,-480,319.5,239.5 (ICL-NUIM)\n"
          "depth/NAME.png         16 bit, z, 1/5000 m (--depth-scale 0.0002), 0 invalid\n",
          detect,
          read,
          write};
}

}  // namespace vdbfuse
