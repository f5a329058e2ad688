// SPDX-License-Identifier: Apache-2.0
#include "formats/camera_text.h"

#include <cmath>

#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr double kLastRowTolerance = 1e-6;

std::string rowText(const Eigen::RowVectorXd& row) {
  std::string text;
  for (const double value : row) text += (text.empty() ? "" : " ") + numberText(value);
  return text;
}

}  // namespace

RigidTransform poseFromMatrix(const std::filesystem::path& path, const std::string& place,
                              const Eigen::MatrixXd& matrix) {
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topRows(matrix.rows()) = matrix;
  const Eigen::RowVector4d last(0, 0, 0, 1);
  if ((pose.row(3) - last).cwiseAbs().maxCoeff() > kLastRowTolerance)
    throw IoError(path, place, "a pose whose last row is 0 0 0 1", rowText(pose.row(3)));
  const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
  if (rotation.determinant() <= 0)
    throw IoError(path, place, "a rotation",
                  "a matrix with determinant " + numberText(rotation.determinant()));
  if (rotationError(rotation) > kRotationTolerance)
    throw IoError(path, place, "a rotation",
                  "a matrix R with |RᵀR - 1| = " + numberText(rotationError(rotation)));
  return rigidFromMatrix(pose);
}

RigidTransform readPoseFile(const std::filesystem::path& path, const std::string& expected) {
  if (!std::filesystem::exists(path)) throw IoError(path, "", expected, "nothing of that name");
  const std::vector<TextLine> lines = readListing(path);
  const int rows = lines.size() == 3 ? 3 : 4;
  return poseFromMatrix(path, linePlace(lines, 0),
                        readMatrix(path, lines, 0, rows, 4, "a 4x4 or 3x4 pose matrix"));
}

RigidTransform poseFromQuaternion(const std::filesystem::path& path, const std::string& place,
                                  const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation) {
  constexpr double kTolerance = 0.01;
  if (!(std::abs(rotation.norm() - 1) <= kTolerance))
    throw IoError(path, place, "a quaternion of length 1", "length " + numberText(rotation.norm()));
  if (!translation.allFinite()) throw IoError(path, place, "a finite position", "another one");
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

Pinhole pinholeFromMatrix(const std::filesystem::path& path, const std::string& place,
                          const Eigen::MatrixXd& matrix, int width, int height) {
  const double tolerance = 1e-6 * std::abs(matrix(0, 0));
  if (!(std::abs(matrix(0, 1)) <= tolerance && std::abs(matrix(1, 0)) <= tolerance)) {
    throw IoError(
        path, place, "intrinsics without skew",
        numberText(matrix(0, 1)) + " and " + numberText(matrix(1, 0)) + " beside the focal lengths");
  }
  if ((matrix.row(2) - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff() > kLastRowTolerance)
    throw IoError(path, place, "intrinsics whose last row is 0 0 1", rowText(matrix.row(2)));
  if (!(matrix(0, 0) > 0 && matrix(1, 1) > 0)) {
    throw IoError(path, place, "focal lengths above 0",
                  numberText(matrix(0, 0)) + " and " + numberText(matrix(1, 1)));
  }
  Pinhole camera;
  camera.width = width, camera.height = height;
  camera.fx = matrix(0, 0), camera.fy = matrix(1, 1);
  camera.cx = matrix(0, 2), camera.cy = matrix(1, 2);
  return camera;
}

}  // namespace vdbfuse
