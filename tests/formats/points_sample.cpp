// SPDX-License-Identifier: Apache-2.0
#include "formats/points_sample.h"

#include <sstream>
#include <string>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"

namespace vdbfuse::test {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::vector<Eigen::Vector3d> inScan(const RigidTransform& world_from_scan) {
  std::vector<Eigen::Vector3d> points = tinySurface();
  for (Eigen::Vector3d& p : points) p = world_from_scan.inverse() * p;
  return points;
}

std::string lines(const std::vector<Eigen::Vector3d>& points, const std::string& end) {
  std::ostringstream text;
  text.precision(6);
  for (const Eigen::Vector3d& p : points) text << p.x() << " " << p.y() << " " << p.z() << end << "\n";
  return text.str();
}

std::string poseText(const RigidTransform& pose) {
  std::ostringstream text;
  text.precision(17);
  text << pose.matrix() << "\n";
  return text.str();
}

std::string positionText(const RigidTransform& pose) {
  std::ostringstream text;
  text << " " << pose.translation().transpose();
  return text.str();
}

std::string plyHeader(const std::string& format, const std::string& type, std::size_t count,
                      bool has_sensor) {
  std::string text = "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(count) + "\n";
  for (const char* name : {"x", "y", "z"}) text += "property " + type + " " + name + "\n";
  for (const char* name : {"sensor_x", "sensor_y", "sensor_z"})
    text += has_sensor ? "property " + type + " " + name + "\n" : "";
  return text + "end_header\n";
}

std::string pcdHeader(const std::string& fields, std::size_t names, std::size_t count,
                      const std::string& data) {
  std::string sizes, types, counts;
  for (std::size_t i = 0; i < names; ++i) sizes += " 4", types += " F", counts += " 1";
  return "VERSION .7\nFIELDS " + fields + "\nSIZE" + sizes + "\nTYPE" + types + "\nCOUNT" + counts +
         "\nWIDTH " + std::to_string(count) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(count) + "\nDATA " + data + "\n";
}

}  // namespace

std::vector<Eigen::Vector3d> tinySurface() {
  std::vector<Eigen::Vector3d> points;
  for (int i = -32; i <= 32; ++i) {
    for (int k = -32; k <= 32; ++k) {
      const double x = 0.025 * i, y = 0.025 * k;
      points.emplace_back(x, y, tinyHeight(x, y));
    }
  }
  return points;
}

std::vector<RigidTransform> tinyScanners() {
  const Eigen::AngleAxisd turn(0.6, Eigen::Vector3d::UnitZ()), tilt(0.1, Eigen::Vector3d::UnitX());
  RigidTransform above = RigidTransform::Identity(), beside = RigidTransform::Identity();
  above.linear() = (turn * tilt).toRotationMatrix();
  above.translation() = Eigen::Vector3d(0.3, -0.25, 1.75);
  beside.linear() = (turn * turn).toRotationMatrix();
  beside.translation() = Eigen::Vector3d(-1.5, 0.5, 1.5);
  return {above, beside};
}

void writeXyzWithPoses(const std::filesystem::path& folder) {
  std::string name = "a";
  for (const RigidTransform& pose : tinyScanners()) {
    writeText(folder / (name + ".xyz"), "# x y z\n" + lines(inScan(pose), ""));
    writeText(folder / (name + ".pose.txt"), poseText(pose));
    name = "b";
  }
}

void writePcdWithTrajectory(const std::filesystem::path& folder) {
  std::ostringstream trajectory;
  trajectory.precision(17);
  trajectory << "# time tx ty tz qx qy qz qw\n";
  double time = 10.5;
  for (const RigidTransform& pose : tinyScanners()) {
    const std::vector<Eigen::Vector3d> points = inScan(pose);
    std::string bytes = pcdHeader("x y z intensity", 4, points.size(), "binary");
    for (const Eigen::Vector3d& p : points) {
      for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(p[k]));
      append(bytes, 0.5F);
    }
    writeText(folder / (std::to_string(time) + ".pcd"), bytes);
    const Eigen::Quaterniond q(pose.linear());
    trajectory << time << " " << pose.translation().transpose() << " " << q.vec().transpose() << " " << q.w()
               << "\n";
    time += 1;
  }
  writeText(folder / "trajectory.txt", trajectory.str());
}

void writePlyWithNumberedPoses(const std::filesystem::path& folder) {
  std::string number = "000";
  for (const RigidTransform& pose : tinyScanners()) {
    const std::vector<Eigen::Vector3d> points = inScan(pose);
    writeText(folder / ("scan" + number + ".ply"),
              plyHeader("ascii", "float", points.size(), false) + lines(points, ""));
    writeText(folder / ("pose" + number + ".txt"), poseText(pose));
    number = "001";
  }
}

void writePlyWithSensors(const std::filesystem::path& folder) {
  const std::vector<Eigen::Vector3d> points = tinySurface();
  std::string bytes = plyHeader("binary_little_endian", "double", 2 * points.size(), true);
  for (const RigidTransform& pose : tinyScanners()) {
    for (const Eigen::Vector3d& p : points) {
      for (int k = 0; k < 3; ++k) append(bytes, p[k]);
      for (int k = 0; k < 3; ++k) append(bytes, pose.translation()[k]);
    }
  }
  writeText(folder / "points.ply", bytes);
}

void writeXyzWithSensors(const std::filesystem::path& folder) {
  std::string text = "//X,Y,Z,SX,SY,SZ\n";
  for (const RigidTransform& pose : tinyScanners()) text += lines(tinySurface(), positionText(pose));
  writeText(folder / "points.xyz", text);
}

void writePcdWithSensors(const std::filesystem::path& folder) {
  const std::vector<Eigen::Vector3d> points = tinySurface();
  std::string text = pcdHeader("x y z vp_x vp_y vp_z", 6, 2 * points.size(), "ascii");
  for (const RigidTransform& pose : tinyScanners()) text += lines(points, positionText(pose));
  writeText(folder / "points.pcd", text);
}

}  // namespace vdbfuse::test
