// SPDX-License-Identifier: Apache-2.0
// Painted stone: a colour for every point of space, so that a surface looks alike from everywhere.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace vdbfuse::synth {

/// Gradient noise (Perlin, SIGGRAPH 1985) in octaves, cells of one tone each (Worley, SIGGRAPH 1996), and
/// specks: contrast at all wavelengths from 0.25 to 0.0005 diagonals of the scene.
class SolidTexture {
 public:
  explicit SolidTexture(std::uint64_t seed);

  /// Share of the light that the point reflects in red, green and blue, in [0.05, 0.95]. Details smaller than
  /// `blur` (a length, > 0) are faded out.
  Eigen::Vector3d albedo(const Eigen::Vector3d& point, double blur) const;

 private:
  // A lattice of its own for each layer, turned so that none lies along the surfaces of a scene.
  struct Layer {
    double size = 0;  ///< wavelength, or edge of a cell
    Eigen::Matrix3d lattice_from_world;
    Eigen::Vector3d shift;
    std::uint32_t key = 0;
    Eigen::Vector3d inLattice(const Eigen::Vector3d& point) const {
      return lattice_from_world * point + shift;
    }
  };
  std::vector<Layer> octaves_, cells_, specks_;
};

}  // namespace vdbfuse::synth
