// SPDX-License-Identifier: Apache-2.0
// Named regions of a scene of which it is known whether they are solid: the cavity that must stay open, the
// leg that must stay. All coordinates are world coordinates.
//
//   {"regions": [
//     {"name": "cavity",    "expect": "outside", "shape": "box", "min": [x, y, z], "max": [x, y, z]},
//     {"name": "left leg",  "expect": "inside",  "shape": "cylinder", "from": [x, y, z], "to": [x, y, z],
//     "radius": r},
//     {"name": "head",      "expect": "inside",  "shape": "sphere", "center": [x, y, z], "radius": r},
//     {"name": "left arm",  "expect": "inside",  "shape": "oriented_box", "center": [x, y, z],
//      "axes": [[x, y, z], [x, y, z], [x, y, z]], "half_extents": [a, b, c]}]}
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "vdbfuse/geometry/box.h"

namespace vdbfuse {

struct RegionSphere {
  Eigen::Vector3d center;
  double radius;
};

/// Solid, with flat ends at `from` and `to`.
struct RegionCylinder {
  Eigen::Vector3d from, to;
  double radius;
};

struct RegionOrientedBox {
  Eigen::Vector3d center;
  Eigen::Matrix3d axes;  ///< columns: three orthogonal unit vectors (the rows of the file, normalised)
  Eigen::Vector3d half_extents;
};

using RegionShape = std::variant<Box, RegionSphere, RegionCylinder, RegionOrientedBox>;

enum class Expectation { Outside, Inside };

struct Region {
  std::string name;
  Expectation expect;
  RegionShape shape;
};

/// Reads a file as above; other members are ignored. IoError that names the byte, or the region and its
/// member.
std::vector<Region> readRegions(const std::filesystem::path& path);

/// `count` points, uniform by volume; the same for the same seed.
std::vector<Eigen::Vector3d> sampleRegion(const RegionShape& shape, std::size_t count, std::uint64_t seed);

}  // namespace vdbfuse
