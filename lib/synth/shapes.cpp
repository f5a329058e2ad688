// SPDX-License-Identifier: Apache-2.0
#include "shapes.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse::synth {
namespace {

using Eigen::Vector3d;

double capsuleDistance(const Vector3d& p, const Vector3d& from, const Vector3d& to, double radius) {
  const Vector3d axis = to - from;
  const double t = std::clamp((p - from).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return (p - from - t * axis).norm() - radius;
}

// Measures of the figure, in parts of its height; feet at z = 0, front towards −y.
constexpr double kLegRadius = 0.02, kLegX = 0.08, kHip = 0.45;
constexpr double kTorsoRounding = 0.12;
constexpr double kArmRadius = 0.03;
constexpr double kHeadRadius = 0.1;
const Vector3d kTorsoCenter{0, 0, 0.6}, kTorsoHalf{0.16, 0.15, 0.2};
const Vector3d kHeadCenter{0, 0, 0.9};
const Vector3d kShoulder{0.145, 0, 0.74}, kHand{0.27, 0, 0.45};
constexpr double kCavityWidth = 0.1, kCavityDepth = 0.2, kCavityZ = 0.62;

Vector3d mirrored(const Vector3d& p) { return {-p.x(), p.y(), p.z()}; }

// Both sides of the figure are alike: everything is measured on the side x ≥ 0.
double figureDistance(const Vector3d& point) {
  const Vector3d p(std::abs(point.x()), point.y(), point.z());
  const Vector3d core = kTorsoHalf - Vector3d::Constant(kTorsoRounding);
  const double front = kTorsoCenter.y() - kTorsoHalf.y();
  // The cavity is a box that sticks out of the front, so that it cuts the rim open.
  const Vector3d cavity_center{0, front, kCavityZ},
      cavity_half{kCavityWidth / 2, kCavityDepth, kCavityWidth / 2};
  const double torso = std::max(boxDistance(p, kTorsoCenter, core) - kTorsoRounding,
                                -boxDistance(p, cavity_center, cavity_half));
  const double neck = capsuleDistance(p, {0, 0, 0.72}, kHeadCenter, 0.045);
  const double head = std::min(neck, (p - kHeadCenter).norm() - kHeadRadius);
  const double leg = capsuleDistance(p, {kLegX, 0, kLegRadius}, {kLegX, 0, kHip}, kLegRadius);
  const double arm = capsuleDistance(p, kShoulder, kHand, kArmRadius);
  return std::min({torso, head, leg, arm});
}

std::vector<SceneRegion> figureRegions() {
  constexpr double kInset = 0.015;  // of the cavity's core from its walls
  const double front = kTorsoCenter.y() - kTorsoHalf.y(), half = kCavityWidth / 2 - kInset;
  const Box cavity(Vector3d(-half, front, kCavityZ - half),
                   Vector3d(half, front + kCavityDepth - kInset, kCavityZ + half));
  const Box torso(Vector3d(-0.09, 0.07, 0.47), Vector3d(0.09, 0.1, 0.73));
  const CylinderShape leg{{kLegX, 0, 0.04}, {kLegX, 0, 0.38}, kLegRadius / 2};
  const CylinderShape arm{kShoulder, kHand, kArmRadius / 2};
  // The figure faces the viewer: its left is at +x.
  return {{"cavity", RegionSide::Outside, cavity},
          {"left leg", RegionSide::Inside, leg},
          {"right leg", RegionSide::Inside, CylinderShape{mirrored(leg.from), mirrored(leg.to), leg.radius}},
          {"torso", RegionSide::Inside, torso},
          {"head", RegionSide::Inside, SphereShape{kHeadCenter, 0.8 * kHeadRadius}},
          {"left arm", RegionSide::Inside, arm},
          {"right arm", RegionSide::Inside, CylinderShape{mirrored(arm.from), mirrored(arm.to), arm.radius}}};
}

Shape figure() {
  const double reach = kHand.x() + kArmRadius;
  return {figureDistance, Box(Vector3d(-reach, -kTorsoHalf.y(), 0), Vector3d(reach, kTorsoHalf.y(), 1)),
          figureRegions()};
}

Shape sphere() {
  const Vector3d one = Vector3d::Ones();
  return {[](const Vector3d& p) { return p.norm() - 1; },
          Box(-one, one),
          {{"core", RegionSide::Inside, SphereShape{Vector3d::Zero(), 0.8}}}};
}

Shape box() {
  const Vector3d half{1.0, 0.6, 0.8};
  return {[half](const Vector3d& p) { return boxDistance(p, Vector3d::Zero(), half); },
          Box(-half, half),
          {{"core", RegionSide::Inside, Box(-0.9 * half, 0.9 * half)}}};
}

Shape torus() {
  constexpr double kMajor = 0.7, kMinor = 0.3;
  const auto distance = [](const Vector3d& p) {
    return std::hypot(std::hypot(p.x(), p.y()) - kMajor, p.z()) - kMinor;
  };
  const CylinderShape hole{{0, 0, -kMinor}, {0, 0, kMinor}, 0.8 * (kMajor - kMinor)};
  const Vector3d half(kMajor + kMinor, kMajor + kMinor, kMinor);
  return {distance, Box(-half, half), {{"hole", RegionSide::Outside, hole}}};
}

// Measures of the occluder: a row of posts before a wall that bends round them, on one floor.
constexpr int kPosts = 5;
constexpr double kPostRadius = 0.055, kPostPitch = 0.2, kPostY = -0.2, kPostTop = 0.27;
constexpr double kBendRadius = 0.7, kBendY = -0.45, kWallThickness = 0.06;
const Vector3d kFloorCenter{0, 0, -0.33}, kFloorHalf{0.5, 0.3, 0.03};
constexpr double kFloorTop = -0.3;
const Vector3d kWallCenter{0, 0.15, 0}, kWallHalf{0.5, 0.15, 0.33};

double postX(int i) { return (i - 0.5 * (kPosts - 1)) * kPostPitch; }

double occluderDistance(const Vector3d& p) {
  const double bend = std::abs(std::hypot(p.x(), p.y() - kBendY) - kBendRadius) - 0.5 * kWallThickness;
  const double wall = std::max(bend, boxDistance(p, kWallCenter, kWallHalf));
  const double nearest = std::clamp(std::round(p.x() / kPostPitch + 0.5 * (kPosts - 1)), 0.0, kPosts - 1.0);
  const double x = postX(static_cast<int>(nearest));
  const Vector3d in_post(x, kPostY, std::clamp(p.z(), kFloorTop, kPostTop));
  const double post = (p - in_post).norm() - kPostRadius;
  return std::min({wall, post, boxDistance(p, kFloorCenter, kFloorHalf)});
}

std::vector<SceneRegion> occluderRegions() {
  constexpr double kInset = 0.015;
  const Box behind(Vector3d(-0.3, kPostY + kPostRadius + kInset, -0.27), Vector3d(0.3, 0.1, 0.3));
  const Box wall(Vector3d(-0.1, 0.235, -0.25), Vector3d(0.1, 0.26, 0.3));
  std::vector<SceneRegion> regions = {{"gap", RegionSide::Outside, behind},
                                      {"wall", RegionSide::Inside, wall}};
  for (int i = 0; i < kPosts; ++i) {
    const CylinderShape post{{postX(i), kPostY, -0.27}, {postX(i), kPostY, kPostTop}, 0.5 * kPostRadius};
    regions.push_back({"post " + std::to_string(i + 1), RegionSide::Inside, post});
  }
  return regions;
}

Shape occluder() {
  const Box bounds(kFloorCenter - kFloorHalf, Vector3d(kWallHalf.x(), kFloorHalf.y(), kWallHalf.z()));
  return {occluderDistance, bounds, occluderRegions()};
}

}  // namespace

double boxDistance(const Vector3d& point, const Vector3d& center, const Vector3d& half_size) {
  const Vector3d d = (point - center).cwiseAbs() - half_size;
  return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
}

std::optional<Shape> shapeNamed(const std::string& name) {
  if (name == "sphere" || name == "ball") return sphere();
  if (name == "box") return box();
  if (name == "torus") return torus();
  if (name == "figure") return figure();
  if (name == "occluder") return occluder();
  return std::nullopt;
}

}  // namespace vdbfuse::synth
