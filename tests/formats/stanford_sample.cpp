// SPDX-License-Identifier: Apache-2.0
#include "formats/stanford_sample.h"

#include <algorithm>
#include <sstream>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse::test {
namespace {

float depthOfPixel(const View& view, int x, int y) {
  const auto above = [&](double depth) {
    const Eigen::Vector3d p = view.world_from_camera * unproject(view.projection, x, y, depth);
    return p.z() - tinyHeight(p.x(), p.y());
  };
  double low = 0.5, high = low;
  while (above(high) > 0 && high < 6) low = high, high += 0.01;
  for (int i = 0; i < 40; ++i) (above(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
  return static_cast<float>(low);
}

enum class Encoding { Ascii, BigEndian };

std::string bigEndian(const void* value, std::size_t size) {
  std::string bytes(static_cast<const char*>(value), size);
  std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string rowText(const Eigen::Vector3f& p, Encoding encoding) {
  std::string bytes;
  for (int k = 0; k < 3 && encoding == Encoding::BigEndian; ++k) bytes += bigEndian(&p[k], 4);
  if (encoding == Encoding::BigEndian) return bytes;
  std::ostringstream text;
  text.precision(9);
  text << p.x() << " " << p.y() << " " << p.z() << "\n";
  return text.str();
}

std::string entryText(int index, Encoding encoding) {
  if (encoding == Encoding::BigEndian)
    return index < 0 ? std::string(1, '\0') : "\1" + bigEndian(&index, sizeof index);
  return index < 0 ? "0\n" : "1 " + std::to_string(index) + "\n";
}

// `points` in the scan's frame, in the order of the file.
std::string scanText(const PointImage& points, Encoding encoding) {
  std::string vertices, grid;
  int count = 0;
  for (const Eigen::Vector3f& p : points) {
    grid += entryText(p.allFinite() ? count : -1, encoding);
    if (!p.allFinite()) continue;
    vertices += rowText(p, encoding);
    ++count;
  }
  return std::string("ply\nformat ") + (encoding == Encoding::Ascii ? "ascii" : "binary_big_endian") +
         " 1.0\nobj_info is_mesh 0\nobj_info num_cols " + std::to_string(points.width()) +
         "\nobj_info num_rows " + std::to_string(points.height()) + "\nelement vertex " +
         std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement range_grid " +
         std::to_string(points.size()) + "\nproperty list uchar int vertex_indices\nend_header\n" + vertices +
         grid;
}

std::string lineText(const std::string& file, const RigidTransform& world_from_scan) {
  const Eigen::Quaterniond q(world_from_scan.linear().transpose());
  std::ostringstream text;
  text.precision(17);
  text << "bmesh " << file << " " << world_from_scan.translation().transpose() << " " << q.x() << " " << q.y()
       << " " << q.z() << " " << q.w() << "\n";
  return text.str();
}

void write(const std::filesystem::path& folder, const std::vector<View>& views,
           const RigidTransform& scan_from_camera, bool from_below, Encoding encoding) {
  std::string text = "camera 0 0 1 0 0 0 1\n\n";
  for (const View& view : views) {
    const std::string file = "scan" + view.name + ".ply";
    const PointImage seen = pointsOf(view);
    PointImage points = noPoints(seen.width(), seen.height());
    for (int y = 0; y < seen.height(); ++y) {
      for (int x = 0; x < seen.width(); ++x)
        points(x, from_below ? seen.height() - 1 - y : y) =
            (scan_from_camera * seen(x, y).cast<double>()).cast<float>();
    }
    writeText(folder / file, scanText(points, encoding));
    text += lineText(file, view.world_from_camera * scan_from_camera.inverse());
  }
  writeText(folder / "scans.conf", text);
}

RigidTransform scanFromCamera(const Eigen::Vector3d& sensor) {
  RigidTransform result = RigidTransform::Identity();
  result.linear().diagonal() << 1, -1, -1;
  result.translation() = sensor;
  return result;
}

}  // namespace

std::vector<View> tinyPushBroomViews() {
  std::vector<View> views = tinyViews(2);
  for (View& view : views) {
    view.projection = PushBroom{40, 30, -1.2, 0.03, 0.3, 30, 14.5};
    view.map = {};
    view.map.depth = Image<float>(40, 30, kInvalidDepth);
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) view.map.depth(x, y) = depthOfPixel(view, x, y);
    }
    view.map.depth(0, 0) = kInvalidDepth;
  }
  return views;
}

void writeStanfordAscii(const std::filesystem::path& folder) {
  write(folder, tinyPushBroomViews(), scanFromCamera({0, 0.2, 1.9}), true, Encoding::Ascii);
}

void writeStanfordBinary(const std::filesystem::path& folder) {
  write(folder, tinyPushBroomViews(), scanFromCamera({0, 0.2, 1.9}), true, Encoding::BigEndian);
}

void writeStanfordPinhole(const std::filesystem::path& folder) {
  write(folder, tinyViews(), scanFromCamera({0, 0, 0}), false, Encoding::Ascii);
}

}  // namespace vdbfuse::test
