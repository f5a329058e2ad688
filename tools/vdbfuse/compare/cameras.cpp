// SPDX-License-Identifier: Apache-2.0
#include "compare/cameras.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "arguments.h"
#include "vdbfuse/report/render.h"

namespace vdbfuse::tool {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = 560, kHeight = 480;

// Angle around `up` from one direction to another; 0 where one of them points up or down.
double angleAround(const Vector3d& up, const Vector3d& from, const Vector3d& to) {
  const Vector3d a = from - from.dot(up) * up, b = to - to.dot(up) * up;
  return a.norm() > 0 && b.norm() > 0 ? std::atan2(up.dot(a.cross(b)), a.dot(b)) : 0;
}

// The turn of framingCamera() that looks from where the sensors were; 0 where they were all around.
double angleOfSensors(const TriangleMesh& mesh, const std::vector<ViewHeader>& views, const Vector3d& up) {
  constexpr double kOneSided = 0.3;
  const Vector3d center = boundingBox(mesh).center();
  Vector3d mean = Vector3d::Zero();
  double distance = 0;
  for (const ViewHeader& view : views) {
    const Vector3d offset = view.world_from_camera.translation() - center;
    mean += offset, distance += offset.norm();
  }
  const Vector3d level = mean - mean.dot(up) * up;
  if (level.norm() < kOneSided * distance) return 0;
  const Vector3d usual = framingCamera(mesh, up, kWidth, kHeight).world_from_camera.translation() - center;
  return angleAround(up, usual, level);
}

ViewHeader ofWidth(ViewHeader view, int width) {
  view.projection = scaled(view.projection, static_cast<double>(width) / imageWidth(view.projection));
  return view;
}

}  // namespace

Vector3d chooseUp(const std::string& name, const std::vector<ViewHeader>& views) {
  if (name != "auto") return axisNamed(name);
  Vector3d mean = Vector3d::Zero();
  for (const ViewHeader& view : views) mean -= view.world_from_camera.linear().col(1);
  constexpr double kInCommon = 0.5;
  if (mean.norm() < kInCommon * static_cast<double>(views.size())) return Vector3d::UnitZ();
  mean.normalize();
  int axis = 0;
  const double most = mean.cwiseAbs().maxCoeff(&axis);
  const double near_axis = std::cos(20 * std::numbers::pi / 180);
  return most > near_axis ? Vector3d(std::copysign(1.0, mean[axis]) * Vector3d::Unit(axis)) : mean;
}

CameraList chooseCameras(const TriangleMesh& mesh, const std::vector<ViewHeader>& views, const Vector3d& up) {
  CameraList cameras;
  const ViewHeader& middle = views[views.size() / 2];
  if (std::holds_alternative<Pinhole>(middle.projection))
    cameras.all.push_back(
        {"view", "From where view " + middle.name + " was taken.", ofWidth(middle, kWidth)});
  cameras.front_index = cameras.all.size();
  const double first = angleOfSensors(mesh, views, up);
  const char* words[] = {"The whole from the front.", "Turned by 120°.", "Turned by 240°."};
  for (int k = 0; k < 3; ++k) {
    const double angle = first + 2 * std::numbers::pi * k / 3;
    cameras.all.push_back(
        {"side" + std::to_string(k + 1), words[k], framingCamera(mesh, up, kWidth, kHeight, angle)});
  }
  return cameras;
}

}  // namespace vdbfuse::tool
