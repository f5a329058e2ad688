// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/look_at.h"

namespace vdbfuse {
namespace {

Eigen::Vector3d mostDifferentAxis(const Eigen::Vector3d& direction) {
  int axis = 0;
  direction.cwiseAbs().minCoeff(&axis);
  return Eigen::Vector3d::Unit(axis);
}

}  // namespace

RigidTransform lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up) {
  constexpr double kParallel = 1e-6;
  const Eigen::Vector3d forward = (target - eye).normalized();
  Eigen::Vector3d right = forward.cross(up.normalized());
  if (right.norm() < kParallel) right = forward.cross(mostDifferentAxis(forward));
  right.normalize();
  RigidTransform world_from_camera = RigidTransform::Identity();
  world_from_camera.linear() << right, forward.cross(right), forward;
  world_from_camera.translation() = eye;
  return world_from_camera;
}

Eigen::Vector3d frontFor(const Eigen::Vector3d& up) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up);
  return turn * -Eigen::Vector3d::UnitY();
}

}  // namespace vdbfuse
