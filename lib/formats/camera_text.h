// SPDX-License-Identifier: Apache-2.0
// Matrices from text files made into poses and cameras, or refused with the line they stand in.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// rigidFromMatrix() with IoError at `place` instead of InvalidArgument. `matrix` is 3×4 or 4×4.
RigidTransform poseFromMatrix(const std::filesystem::path& path, const std::string& place,
                              const Eigen::MatrixXd& matrix);

/// The pose in a text file of nothing but 3 or 4 rows of 4 numbers. `expected` names it in errors where there
/// is no such file: "the pose of a.depth.png". Throws IoError.
RigidTransform readPoseFile(const std::filesystem::path& path, const std::string& expected);

/// The pose of a translation and a unit quaternion. Throws IoError at `place` when its length is off by more
/// than a hundredth or a number is not finite.
RigidTransform poseFromQuaternion(const std::filesystem::path& path, const std::string& place,
                                  const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation);

/// The camera of a 3×3 matrix (fx 0 cx; 0 fy cy; 0 0 1) for images of the given size. Throws IoError when the
/// matrix is of another form.
Pinhole pinholeFromMatrix(const std::filesystem::path& path, const std::string& place,
                          const Eigen::MatrixXd& matrix, int width, int height);

}  // namespace vdbfuse
