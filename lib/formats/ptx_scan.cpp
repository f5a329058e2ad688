// SPDX-License-Identifier: Apache-2.0
#include "formats/ptx_scan.h"

#include <cmath>
#include <string>

#include "formats/camera_text.h"
#include "formats/scan_grid.h"
#include "io/image_size.h"
#include "io/line_stream.h"
#include "io/text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using io::LineStream;

constexpr std::uint64_t kShortestLine = 6;  // "0 0 0" and its end

std::string shown(std::string_view text) { return "'" + std::string(text.substr(0, 40)) + "'"; }

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  const std::size_t end = text.find_last_not_of(" \t");
  return end == text.npos ? std::string_view() : text.substr(begin, end + 1 - begin);
}

// Reads the lines of one file in order.
class Indexer {
 public:
  explicit Indexer(const fs::path& path) : path_(path), lines_(path) {}

  // Goes to the next line that is not blank; false at the end.
  bool findScan() {
    while (lines_.next()) {
      if (!trimmed(lines_.text()).empty()) return true;
    }
    return false;
  }

  PtxScan readScan() {
    PtxScan scan;
    scan.path = path_;
    const std::int64_t columns = count("the number of columns");
    advance("the number of rows");
    const std::string place = lines_.place();
    const std::int64_t rows = count("the number of rows");
    checkImageSize(path_, place, columns, rows);
    scan.columns = static_cast<int>(columns), scan.rows = static_cast<int>(rows);
    scan.world_from_scanner = scannerPose();
    scan.world_from_points = matrix();
    scan.first_byte = lines_.position(), scan.first_line = lines_.number() + 1;
    skipPoints(scan);
    return scan;
  }

 private:
  void advance(const std::string& expected) {
    if (!lines_.next()) throw IoError(path_, endPlace(), expected, "the end of the file");
  }

  std::string endPlace() const { return "line " + std::to_string(lines_.number() + 1); }

  std::int64_t count(const std::string& what) const {
    const auto value = io::parseInteger(trimmed(lines_.text()));
    if (!value) throw IoError(path_, lines_.place(), what, shown(lines_.text()));
    return *value;
  }

  template <int size>
  Eigen::Matrix<double, 1, size> numbers(const std::string& what) {
    advance(what);
    Eigen::Matrix<double, 1, size> row;
    std::string_view rest = lines_.text();
    for (double& value : row) value = io::takeNumber(rest);
    if (!row.allFinite() || !trimmed(rest).empty())
      throw IoError(path_, lines_.place(), what, shown(lines_.text()));
    return row;
  }

  std::optional<RigidTransform> scannerPose() {
    Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
    pose.topRightCorner<3, 1>() = numbers<3>("the scanner's position x y z").transpose();
    for (int i = 0; i < 3; ++i)
      pose.block<3, 1>(0, i) = numbers<3>("an axis of the scanner x y z").transpose();
    try {
      return rigidFromMatrix(pose);
    } catch (const InvalidArgument&) {
      return std::nullopt;  // some programs leave it all zero
    }
  }

  RigidTransform matrix() {
    Eigen::Matrix4d rows;
    for (int i = 0; i < 4; ++i) rows.row(i) = numbers<4>("a row of the 4x4 matrix");
    return poseFromMatrix(path_, "line " + std::to_string(lines_.number() - 3), rows.transpose());
  }

  void skipPoints(PtxScan& scan) {
    const std::uint64_t points =
        static_cast<std::uint64_t>(scan.columns) * static_cast<std::uint64_t>(scan.rows);
    const std::string expected =
        std::to_string(points) + " points of a " + sizeText(scan.columns, scan.rows) + " scan";
    if (points * kShortestLine > lines_.bytesLeft() + 1)
      throw IoError(path_, endPlace(), expected, std::to_string(lines_.bytesLeft()) + " bytes");
    for (std::uint64_t i = 0; i < points; ++i) {
      advance(expected);
      if (i == 0) scan.has_color = std::isfinite(lastOfSeven(lines_.text()));
    }
  }

  static double lastOfSeven(std::string_view text) {
    double value = 0;
    for (int i = 0; i < 7; ++i) value = io::takeNumber(text);
    return value;
  }

  const fs::path& path_;
  LineStream lines_;
};

Eigen::Vector3d pointOf(const PtxScan& scan, const LineStream& lines) {
  std::string_view rest = lines.text();
  Eigen::Vector3d point;
  for (double& value : point) {
    const std::size_t before = rest.size();
    value = io::takeNumber(rest);
    if (rest.size() == before)
      throw IoError(scan.path, lines.place(), "x y z and an intensity", shown(lines.text()));
  }
  return point;
}

}  // namespace

std::vector<PtxScan> indexPtx(const fs::path& path) {
  Indexer indexer(path);
  std::vector<PtxScan> scans;
  while (indexer.findScan()) scans.push_back(indexer.readScan());
  if (scans.empty()) throw IoError(path, "", "a scan", "an empty file");
  return scans;
}

PointImage readPtxPoints(const PtxScan& scan, const RigidTransform& camera_from_points) {
  LineStream lines(scan.path, scan.first_byte, scan.first_line);
  PointImage points = noPoints(scan.columns, scan.rows);
  for (int column = 0; column < scan.columns; ++column) {
    for (int row = 0; row < scan.rows; ++row) {
      if (!lines.next()) throw IoError(scan.path, "changed since it was indexed");
      const Eigen::Vector3d point = pointOf(scan, lines);
      if (!point.isZero(0)) points(column, row) = scannedPoint(camera_from_points * point);
    }
  }
  return upright(std::move(points));
}

}  // namespace vdbfuse
