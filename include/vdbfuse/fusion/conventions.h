// SPDX-License-Identifier: Apache-2.0
// Whether views agree with each other, and if not, which other reading of their poses and depths would: most
// bad fusions come from a convention taken wrongly, and depth maps of one scene can tell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

/// Another reading of the numbers on disk than the one that gave the views. A default-constructed one changes
/// nothing.
struct Convention {
  /// Of the pose P = (R, t) that was taken for world_from_camera.
  enum class Pose {
    AsRead,
    Inverse,     ///< it is camera_from_world
    Transposed,  ///< the rotation is Rᵀ, the translation t (a matrix by columns, a quaternion conjugated)
    InverseTransposed,   ///< of P⁻¹ = (S, s): it is (Sᵀ, s), camera_from_world
    ScalarFirst,         ///< the quaternion read as x y z w is w x y z
    ScalarLast,          ///< the quaternion read as w x y z is x y z w
    InverseScalarFirst,  ///< the same for the quaternion of P⁻¹
    InverseScalarLast,
  } pose = Pose::AsRead;
  /// The camera's axes are x right, y up, z backward (OpenGL), where x right, y down, z forward was taken; or
  /// the other way round, which is the same change.
  enum class Axes { AsRead, Flipped } axes = Axes::AsRead;
  /// Pinholes only: what was taken for z is the distance along the ray, or the other way round.
  enum class Depth { AsRead, Range, Z } depth = Depth::AsRead;
  /// Depths times this.
  double depth_factor = 1.0;

  bool operator==(const Convention&) const = default;
};

/// "inverse,opengl,range,depth*0.001"; "as-read" when nothing is changed.
std::string nameOf(const Convention& convention);

/// The inverse of nameOf(); nothing when a word of the list is unknown.
std::optional<Convention> conventionNamed(const std::string& name);

/// In words, for a warning: "poses are camera_from_world; camera axes are those of OpenGL".
std::string describe(const Convention& convention);

/// The views under another reading. `stored_from_camera` (one a view, or empty for the identity) is the frame
/// that the poses on disk speak of, from the camera's.
ViewSequence underConvention(const ViewSequence& views, const std::vector<RigidTransform>& stored_from_camera,
                             const Convention& convention);

struct ConventionOptions {
  /// Views that are compared with each other, evenly spread over the sequence. More see more, in quadratic
  /// time.
  std::size_t views = 16;
  /// Pixels of each view that are looked for in the others.
  std::size_t samples = 300;
  /// How far from another view's surface a point may lie and still be on it, as a share of the size of what
  /// one view sees (the diagonal of the box of its points, a twentieth left out at each side; median of the
  /// views).
  double tolerance = 0.015;
  /// Where the views agree this well as they were read, no other reading is tried: the check then costs
  /// hardly more than loading the views. 1: all are tried.
  double enough = 1.0;
};

/// How well views agree under one reading.
struct RatedConvention {
  Convention convention;
  /// Of the points of one view that fall on measured pixels of others: the share that lies on the surfaces of
  /// more of them than it contradicts (where it floats before a surface; behind one counts the less the more
  /// the views' directions differ). Lower where hardly any fall on others.
  double agreement = 0;
};

struct ConventionCheck {
  /// As the views were read; nothing when they do not overlap enough under any reading to tell.
  std::optional<double> agreement;
  /// The reading that agrees clearly better, if there is one: by a third of what is missing to all, or three
  /// times as well. Of readings that agree nearly alike, the one that changes least.
  std::optional<RatedConvention> better;
};

/// Compares a few views with each other under 210 readings: about a second. The result does not depend on the
/// number of threads. Throws what ViewSequence::load() throws; Cancelled.
ConventionCheck checkConvention(const ViewSequence& views,
                                const std::vector<RigidTransform>& stored_from_camera = {},
                                const ConventionOptions& options = {}, const Progress& progress = Progress());

}  // namespace vdbfuse
