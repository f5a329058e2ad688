// SPDX-License-Identifier: Apache-2.0
#include "formats/e57.h"

#include <algorithm>
#include <memory>

#include "formats/e57_pages.h"
#include "formats/e57_points.h"
#include "formats/e57_scan.h"
#include "formats/point_views.h"
#include "io/file_bytes.h"
#include "io/folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

struct Source {
  fs::path path;
  std::vector<E57Scan> scans;
};

std::vector<E57Scan> scansOf(const fs::path& path) {
  io::E57Pages pages(path);
  return parseE57(path, pages.xml(), io::fileSize(path));
}

// A file of one scan may leave the pose out: the scanner is the world's origin.
void requirePoses(const fs::path& path, const std::vector<E57Scan>& scans) {
  if (scans.size() == 1) return;
  for (const E57Scan& scan : scans) {
    if (!scan.world_from_scanner)
      throw IoError(path, scan.place, "a pose, as the file has several scans", "none");
  }
}

std::string nameOf(const E57Scan& scan, std::size_t index) {
  return scan.name.empty() ? "scan_" + std::to_string(index + 1) : scan.name;
}

std::string storedText(const fs::path& path, const E57Scan& scan) {
  const E57Selection selection = selectFields(path, scan);
  const E57Field& first = scan.fields[selection.coordinates[0]];
  const bool is_float = first.type != E57Field::Type::Integer;
  return std::string(selection.is_spherical ? "range, azimuth and elevation" : "x y z") + " as " +
         std::to_string(first.bits) + (is_float ? "-bit floats" : "-bit integers");
}

// What is left out of the points, in a few words.
std::vector<std::string> notesOn(const std::vector<E57Scan>& scans, std::size_t empty) {
  std::vector<std::string> notes;
  if (empty > 0) notes.push_back(counted(empty, "scan") + " without points left out");
  const auto colored = static_cast<std::size_t>(std::count_if(
      scans.begin(), scans.end(), [](const E57Scan& s) { return s.find("colorRed").has_value(); }));
  if (colored > 0) notes.push_back("colours of " + counted(colored, "scan") + " left out");
  const bool has_pose = std::all_of(scans.begin(), scans.end(),
                                    [](const E57Scan& s) { return s.world_from_scanner.has_value(); });
  if (!has_pose) notes.emplace_back("no pose: the scanner is taken to be the world's origin");
  return notes;
}

Detection detect(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {Detection::Fit::No, "no file"};
  if (!io::readFileStart(path, 8).starts_with("ASTM-E57"))
    return {Detection::Fit::No, "no ASTM-E57 at its start"};
  return {Detection::Fit::Fully, "an E57 file"};
}

}  // namespace

DepthSet readE57(const fs::path& path, const ReadOptions& options) {
  auto source = std::make_shared<Source>(Source{path, scansOf(path)});
  requirePoses(path, source->scans);
  const std::size_t all = source->scans.size();
  std::erase_if(source->scans, [](const E57Scan& scan) { return scan.record_count == 0; });
  if (source->scans.empty()) throw IoError(path, "data3D", "a scan with points", "none");
  ScanSource views;
  for (std::size_t i = 0; i < source->scans.size(); ++i) {
    const E57Scan& scan = source->scans[i];
    ViewHeader header;
    header.name = nameOf(scan, i);
    header.world_from_camera =
        scan.world_from_scanner.value_or(RigidTransform::Identity()) * cameraFromScanner().inverse();
    views.headers.push_back(std::move(header));
  }
  views.stored_from_camera.assign(views.headers.size(), cameraFromScanner().inverse());
  views.load = [source](std::size_t index) { return readE57Points(source->path, source->scans[index]); };
  views.stored = storedText(path, source->scans.front());
  views.invalid = "an invalid state other than 0, not finite";
  views.pose = "quaternion and translation world_from_scanner, x forward, y left, z up";
  const std::vector<std::string> notes = notesOn(source->scans, all - source->scans.size());
  DepthSet set = setOfScans(path, std::move(views), options, "e57");
  set.notes.insert(set.notes.end(), notes.begin(), notes.end());
  return set;
}

DepthSetFormat e57Format() {
  return {"e57", "laser scans with poses (ASTM E2807)",
          "NAME.e57   data3D with a pose each; cartesianX/Y/Z or sphericalRange/Azimuth/Elevation;\n"
          "           with rowIndex and columnIndex, or loose points; bitpack codec\n",
          detect, readE57};
}

}  // namespace vdbfuse
