// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/rgbd_folder.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "io/camera_text.h"
#include "io/folder.h"
#include "io/image_size.h"
#include "io/stored_depth.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

constexpr std::string_view kDepthSuffix = ".depth.png";
constexpr std::string_view kPoseSuffix = ".pose.txt";
constexpr double kMetresPerMillimetre = 0.001;

// Where the images of the frames lie; shared by all copies of the sequence.
struct Frames {
  std::filesystem::path folder;
  std::vector<std::string> names;
  std::vector<Projection> projections;
  std::vector<std::filesystem::path> pictures;  // empty path: none
  ReadOptions options;
};

std::vector<std::string> intrinsicsFiles(const std::filesystem::path& folder) {
  std::vector<std::string> names = filesEndingWith(folder, ".txt");
  std::erase_if(names, [](const std::string& name) { return name.find("intrinsics") == std::string::npos; });
  return names;
}

struct Intrinsics {
  std::filesystem::path path;
  std::string place;
  Eigen::MatrixXd matrix;
};

Intrinsics readIntrinsics(const std::filesystem::path& folder) {
  const std::vector<std::string> files = intrinsicsFiles(folder);
  if (files.empty()) throw IoError(folder, "", "an intrinsics file (*intrinsics*.txt)", "none");
  if (files.size() > 1)
    throw IoError(folder, "", "one intrinsics file (*intrinsics*.txt)", files[0] + " and " + files[1]);
  const std::filesystem::path path = folder / files.front();
  const std::vector<TextLine> lines = readTextLines(path);
  return {path, linePlace(lines, 0), readMatrix(path, lines, 0, 3, 3, "a 3x3 matrix of intrinsics")};
}

RigidTransform readPose(const std::filesystem::path& path, const std::string& depth_name) {
  if (!std::filesystem::exists(path))
    throw IoError(path, "", "the pose of " + depth_name, "nothing of that name");
  const std::vector<TextLine> lines = readTextLines(path);
  const int rows = lines.size() == 3 ? 3 : 4;
  return poseFromMatrix(path, linePlace(lines, 0),
                        readMatrix(path, lines, 0, rows, 4, "a 4x4 or 3x4 pose matrix"));
}

Image<float> readDepth(const std::filesystem::path& path) {
  const Image<std::uint16_t> stored = readPngGrey16(path);
  constexpr std::uint16_t kSaturated = std::numeric_limits<std::uint16_t>::max();
  Image<float> depth(stored.width(), stored.height());
  std::transform(stored.begin(), stored.end(), depth.begin(),
                 [](std::uint16_t v) { return v == kSaturated ? kInvalidDepth : static_cast<float>(v); });
  return depth;
}

DepthMap loadFrame(const Frames& frames, std::size_t index) {
  const std::filesystem::path path = frames.folder / (frames.names[index] + std::string(kDepthSuffix));
  const Projection& projection = frames.projections[index];
  Image<float> stored = readDepth(path);
  if (stored.width() != imageWidth(projection) || stored.height() != imageHeight(projection))
    throw IoError(path, "changed since its header was read");
  DepthMap map;
  map.depth = sensorDepth(std::move(stored), projection,
                          encodingFor(frames.options, projection, kMetresPerMillimetre), frames.options);
  if (frames.options.color == ReadOptions::Color::Load && !frames.pictures[index].empty())
    map.color = readPicture(frames.pictures[index]);
  return map;
}

std::vector<std::string> notesOn(const Frames& frames, const Intrinsics& intrinsics) {
  std::vector<std::string> notes;
  const auto pictures = static_cast<std::size_t>(std::count_if(frames.pictures.begin(), frames.pictures.end(),
                                                               [](const auto& p) { return !p.empty(); }));
  if (pictures > 0 && pictures < frames.names.size())
    notes.push_back("colour for " + std::to_string(pictures) + " of " + counted(frames.names.size(), "view"));
  const std::size_t poses = filesEndingWith(frames.folder, kPoseSuffix).size();
  if (poses > frames.names.size())
    notes.push_back(counted(poses - frames.names.size(), "pose") + " without a depth map left out");
  const auto& first = std::get<Pinhole>(frames.projections.front());
  if (first.cx < 0 || first.cy < 0 || first.cx >= first.width || first.cy >= first.height) {
    notes.push_back("the principal point of " + intrinsics.path.filename().string() + " lies outside the " +
                    sizeText(first.width, first.height) + " depth map");
  }
  return notes;
}

}  // namespace

Detection detectRgbdFolder(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {Detection::Fit::No, "not a folder"};
  const std::size_t depths = filesEndingWith(path, kDepthSuffix).size();
  if (depths == 0) return {Detection::Fit::No, "no *.depth.png"};
  if (intrinsicsFiles(path).empty()) return {Detection::Fit::Partly, "*.depth.png, but no *intrinsics*.txt"};
  if (filesEndingWith(path, kPoseSuffix).empty())
    return {Detection::Fit::Partly, "*.depth.png, but no *.pose.txt"};
  return {Detection::Fit::Fully, counted(depths, "depth map") + " with poses and intrinsics"};
}

DepthSet readRgbdFolder(const std::filesystem::path& path, const ReadOptions& options) {
  if (!std::filesystem::is_directory(path)) throw IoError(path, "", "a folder", "a file");
  auto frames = std::make_shared<Frames>();
  frames->folder = path;
  frames->options = options;
  const std::vector<std::string> files = filesEndingWith(path, kDepthSuffix);
  if (files.empty()) throw IoError(path, "", "depth maps (*.depth.png)", "none");
  const Intrinsics intrinsics = readIntrinsics(path);
  std::vector<ViewHeader> headers;
  for (const std::string& file : files) {
    const std::string name = file.substr(0, file.size() - kDepthSuffix.size());
    ViewHeader header;
    header.name = name;
    header.world_from_camera = readPose(path / (name + std::string(kPoseSuffix)), file);
    const PngHeader size = readPngHeader(path / file);
    header.projection =
        pinholeFromMatrix(intrinsics.path, intrinsics.place, intrinsics.matrix, size.width, size.height);
    frames->names.push_back(name);
    frames->projections.push_back(header.projection);
    frames->pictures.push_back(findPicture(path, name + ".color"));
    headers.push_back(std::move(header));
  }
  DepthSet set;
  set.notes = notesOn(*frames, intrinsics);
  set.views =
      ViewSequence(std::move(headers), [frames](std::size_t index) { return loadFrame(*frames, index); });
  return set;
}

}  // namespace vdbfuse
