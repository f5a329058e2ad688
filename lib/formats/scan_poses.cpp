// SPDX-License-Identifier: Apache-2.0
#include "formats/scan_poses.h"

#include <algorithm>
#include <map>
#include <optional>

#include "formats/camera_text.h"
#include "io/folder.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

RigidTransform poseOfLine(const fs::path& path, TextLine line) {
  line.words.erase(line.words.begin());
  const std::vector<double> v = finiteNumbers(path, line);
  return poseFromQuaternion(path, "line " + std::to_string(line.number), {v[0], v[1], v[2]},
                            Eigen::Quaterniond(v[6], v[3], v[4], v[5]));
}

// By the first word of their lines, and in the order of the file.
struct Trajectory {
  std::map<std::string, RigidTransform> by_name;
  std::vector<RigidTransform> in_order;
  std::optional<RigidTransform> named(const std::string& file) const {
    for (const std::string& name : {file, fs::path(file).stem().string()}) {
      if (const auto found = by_name.find(name); found != by_name.end()) return found->second;
    }
    return std::nullopt;
  }
};

Trajectory readLines(const fs::path& path) {
  constexpr std::size_t kWords = 8;
  Trajectory trajectory;
  for (const TextLine& line : readListing(path)) {
    if (line.words.size() != kWords)
      throw IoError(path, "line " + std::to_string(line.number), "name tx ty tz qx qy qz qw",
                    counted(line.words.size(), "word"));
    trajectory.in_order.push_back(poseOfLine(path, line));
    trajectory.by_name.emplace(line.words.front(), trajectory.in_order.back());
  }
  return trajectory;
}

std::vector<RigidTransform> fromTrajectory(const fs::path& path, const std::vector<std::string>& files) {
  const Trajectory trajectory = readLines(path);
  std::vector<RigidTransform> poses;
  std::string missing;
  for (const std::string& file : files) {
    const auto pose = trajectory.named(file);
    if (pose) poses.push_back(*pose);
    if (!pose && missing.empty()) missing = file;
  }
  if (missing.empty()) return poses;
  if (!poses.empty()) throw IoError(path, "", "the pose of " + missing, "none of that name");
  if (trajectory.in_order.size() != files.size())
    throw IoError(path, "", "a line for each of " + counted(files.size(), "scan"),
                  counted(trajectory.in_order.size(), "line"));
  return trajectory.in_order;
}

}  // namespace

fs::path poseFileOf(const fs::path& folder, const std::string& scan) {
  std::error_code ignored;
  const std::string stem = fs::path(scan).stem().string();
  if (fs::path beside = folder / (stem + ".pose.txt"); fs::exists(beside, ignored)) return beside;
  const std::string_view number = std::string_view(stem).substr(std::min<std::size_t>(4, stem.size()));
  if (!stem.starts_with("scan") || number.empty() ||
      number.find_first_not_of("0123456789") != std::string_view::npos)
    return {};
  fs::path numbered = folder / ("pose" + std::string(number) + ".txt");
  return fs::exists(numbered, ignored) ? numbered : fs::path();
}

std::vector<RigidTransform> readScanPoses(const fs::path& folder, const std::vector<std::string>& files) {
  std::error_code ignored;
  if (fs::exists(folder / kTrajectoryFile, ignored)) return fromTrajectory(folder / kTrajectoryFile, files);
  std::vector<RigidTransform> poses;
  for (const std::string& file : files) {
    const fs::path path = poseFileOf(folder, file);
    if (path.empty())
      throw IoError(folder, "", "the pose of " + file + " (" + fs::path(file).stem().string() + ".pose.txt)",
                    "nothing of that name");
    poses.push_back(readPoseFile(path, "the pose of " + file));
  }
  return poses;
}

}  // namespace vdbfuse
