// SPDX-License-Identifier: Apache-2.0
#include "formats/ptx.h"

#include <algorithm>
#include <charconv>
#include <memory>

#include "formats/image_writer.h"
#include "formats/point_views.h"
#include "formats/ptx_scan.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

// What the digits of text may be off: of an axis, and of a position for each length it is away from zero.
constexpr double kSameAxis = 1e-3, kSamePosition = 1e-6;

// A scan and the axes its points are in.
struct Scan {
  PtxScan stored;
  RigidTransform camera_from_points = cameraFromScanner();
  bool is_in_world = false;
};

bool isPtx(const fs::path& path) { return path.extension() == ".ptx" || path.extension() == ".PTX"; }

std::vector<fs::path> filesAt(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const char* suffix : {".PTX", ".ptx"}) {
    for (const std::string& name : filesEndingWith(path, suffix)) files.push_back(path / name);
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool isSame(const RigidTransform& a, const RigidTransform& b) {
  return (a.linear() - b.linear()).cwiseAbs().maxCoeff() < kSameAxis &&
         (a.translation() - b.translation()).norm() < kSameAxis + kSamePosition * a.translation().norm();
}

bool isOfASensor(const PointImage& points) {
  try {
    PointScan scan;
    scan.organised = points;
    return projectionOf(scan, {}).origin == ScanProjection::Origin::Fitted;
  } catch (const InvalidArgument&) {
    return false;
  }
}

Scan placed(const PtxScan& stored) {
  Scan scan;
  scan.stored = stored;
  if (!stored.world_from_scanner || isSame(*stored.world_from_scanner, stored.world_from_points)) return scan;
  if (isOfASensor(readPtxPoints(stored, scan.camera_from_points))) return scan;
  const RigidTransform camera_from_points =
      cameraFromScanner() * stored.world_from_scanner->inverse() * stored.world_from_points;
  scan.is_in_world = isOfASensor(readPtxPoints(stored, camera_from_points));
  if (scan.is_in_world) scan.camera_from_points = camera_from_points;
  return scan;
}

std::vector<Scan> scansOf(const std::vector<fs::path>& files, std::vector<ViewHeader>& headers) {
  std::vector<Scan> scans;
  for (const fs::path& file : files) {
    const std::vector<PtxScan> found = indexPtx(file);
    for (std::size_t i = 0; i < found.size(); ++i) {
      ViewHeader header;
      header.name = file.stem().string() + (found.size() > 1 ? "_" + std::to_string(i + 1) : "");
      scans.push_back(placed(found[i]));
      header.world_from_camera = found[i].world_from_points * scans.back().camera_from_points.inverse();
      headers.push_back(std::move(header));
    }
  }
  return scans;
}

void addNotes(const std::vector<Scan>& scans, std::vector<std::string>& notes) {
  const auto counts = [&](const auto& holds) {
    return static_cast<std::size_t>(std::count_if(scans.begin(), scans.end(), holds));
  };
  if (const std::size_t moved = counts([](const Scan& s) { return s.is_in_world; }); moved > 0)
    notes.push_back(counted(moved, "scan") + " in other axes than the scanner's, taken back to its pose");
  if (const std::size_t colored = counts([](const Scan& s) { return s.stored.has_color; }); colored > 0)
    notes.push_back("colours of " + counted(colored, "scan") + " left out");
}

Detection detect(const fs::path& path) {
  if (!fs::is_directory(path))
    return isPtx(path) ? Detection{Detection::Fit::Fully, "a .ptx file"}
                       : Detection{Detection::Fit::No, "not a folder and no .ptx file"};
  const std::size_t files = filesAt(path).size();
  if (files == 0) return {Detection::Fit::No, "no *.ptx"};
  return {Detection::Fit::Fully, counted(files, "scan file")};
}

// Shortest text that reads back as the same float.
void append(std::string& text, float value) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void appendPoint(std::string& text, const Eigen::Vector3d& point) {
  for (const double value : point) append(text, static_cast<float>(value)), text += ' ';
  text += "0.5\n";  // the intensity of "unknown"
}

std::string axesText(const RigidTransform& pose) {
  return matrixText(pose.translation().transpose()) + matrixText(pose.linear().transpose()) +
         matrixText(pose.matrix().transpose());
}

std::string scanText(const View& view) {
  const Image<float>& depth = view.map.depth;
  std::string text = std::to_string(depth.width()) + "\n" + std::to_string(depth.height()) + "\n" +
                     axesText(view.world_from_camera * cameraFromScanner());
  const RigidTransform scanner_from_camera = cameraFromScanner().inverse();
  for (int x = 0; x < depth.width(); ++x) {
    for (int y = depth.height() - 1; y >= 0; --y) {
      if (depth(x, y) == kInvalidDepth)
        text += "0 0 0 0.5\n";
      else
        appendPoint(text, scanner_from_camera * unproject(view.projection, x, y, depth(x, y)));
    }
  }
  return text;
}

void write(const fs::path& folder, const ViewSequence& views, const WriteOptions&, const Progress& progress) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!std::holds_alternative<Spherical>(views.header(i).projection)) plainPinhole(views.header(i), "ptx");
  }
  forEachView(views, progress, [&](const View& view, const std::string& name) {
    io::writeFileBytes(folder / (name + ".ptx"), scanText(view));
  });
}

}  // namespace

DepthSet readPtx(const fs::path& path, const ReadOptions& options) {
  const std::vector<fs::path> files = filesAt(path);
  if (files.empty()) throw IoError(path, "", "scans (*.ptx)", "none");
  ScanSource source;
  const auto scans = std::make_shared<const std::vector<Scan>>(scansOf(files, source.headers));
  source.load = [scans](std::size_t index) {
    PointScan scan;
    scan.organised = readPtxPoints((*scans)[index].stored, (*scans)[index].camera_from_points);
    return scan;
  };
  for (const Scan& scan : *scans) source.stored_from_camera.push_back(scan.camera_from_points.inverse());
  source.stored = "x y z as text";
  source.invalid = "0 0 0";
  source.pose = "4x4 matrix of row vectors, world_from_scanner transposed: x forward, y left, z up";
  DepthSet set = setOfScans(path, std::move(source), options, "ptx");
  addNotes(*scans, set.notes);
  return set;
}

DepthSetFormat ptxFormat() {
  return {"ptx",
          "scans of a turning scanner as text (Leica PTX), one file or a folder",
          "NAME.ptx   one or several scans, each: columns, rows, scanner position, 3 axes,\n"
          "           4x4 matrix of row vectors, then a line x y z intensity [r g b] a point,\n"
          "           column by column; 0 0 0 is no return; x forward, y left, z up\n",
          detect,
          readPtx,
          write};
}

}  // namespace vdbfuse
