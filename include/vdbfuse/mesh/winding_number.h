// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

struct WindingNumberOptions {
  /// A group of triangles is replaced by its dipole where it is further away than this times its radius.
  /// Larger is slower and more exact; the error of one query falls with its square.
  double accuracy = 2.5;
};

/// The generalised winding number of a triangle soup (Jacobson et al., SIGGRAPH 2013): the sum of the signed
/// solid angles of all triangles over 4π. 1 inside and 0 outside of a closed mesh, in between for an open
/// one; negative inside of a mesh that is inside out. Evaluated over a tree whose far nodes act as dipoles
/// (Barill et al., SIGGRAPH 2018); near nodes exactly. Triangles with a vertex that is not finite are
/// ignored.
class WindingNumber {
 public:
  /// REQUIRES: every index of the mesh in range; accuracy > 1.
  explicit WindingNumber(const TriangleMesh& mesh, const WindingNumberOptions& options = {});
  ~WindingNumber();
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;

  /// Safe from any number of threads.
  double at(const Eigen::Vector3d& point) const;
  /// Whether the winding number is above one half: the best answer an open mesh has.
  bool inside(const Eigen::Vector3d& point) const { return at(point) > 0.5; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Signed solid angle of the triangle a b c seen from `point`, in steradians; positive where the triangle
/// turns its back (it is clockwise as seen from the point). Van Oosterom and Strackee, 1983.
double solidAngle(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c);

}  // namespace vdbfuse
