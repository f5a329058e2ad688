// SPDX-License-Identifier: Apache-2.0
#include "solid_texture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vdbfuse::synth {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kCoarsest = 0.25;  // wavelength of the first octave
constexpr int kOctaves = 10;
constexpr double kOctaveContrast = 0.075;
constexpr double kCellSizes[] = {0.05, 0.014};
constexpr double kCellContrast = 0.09, kPaint = 0.07;
constexpr double kSpeckSizes[] = {0.022, 0.008, 0.003};
constexpr double kSpeckContrast = 0.3;

// 32 well mixed bits; the last steps are the finaliser of MurmurHash3.
std::uint32_t hash(const Vector3i& node, std::uint32_t layer) {
  std::uint32_t h = layer * 0x9e3779b9U;
  for (int a = 0; a < 3; ++a) h = (h ^ static_cast<std::uint32_t>(node[a])) * 0x85ebca6bU + (h >> 13);
  h = (h ^ h >> 16) * 0x85ebca6bU;
  h = (h ^ h >> 13) * 0xc2b2ae35U;
  return h ^ h >> 16;
}

// Three numbers in [0, 1) from one hash.
Vector3d spread(std::uint32_t h) { return Vector3d(h & 1023, h >> 10 & 1023, h >> 20 & 1023) / 1024.0; }

double signedTone(std::uint32_t h) { return 2 * spread(h * 0x9e3779b1U).y() - 1; }

// 0 below one pixel a wavelength, 1 above two and a half.
double visibleShare(double wavelength, double blur) {
  const double t = std::clamp((wavelength / blur - 1) / 1.5, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

Vector3i floorOf(const Vector3d& p) { return p.array().floor().cast<int>(); }

// Gradient noise with a standard deviation of 1 and a wavelength of about 1.5.
double gradientNoise(const Vector3d& p, std::uint32_t layer) {
  constexpr double kDeviation = 0.25;
  const Vector3i node = floorOf(p);
  const Vector3d f = p - node.cast<double>();
  const Vector3d s = f.array().cube() * (f.array() * (f.array() * 6 - 15) + 10);
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vector3i corner(c & 1, c >> 1 & 1, c >> 2);
    const Vector3d slope = 2 * spread(hash(node + corner, layer)) - Vector3d::Ones();
    double weight = 1;
    for (int a = 0; a < 3; ++a) weight *= corner[a] != 0 ? s[a] : 1 - s[a];
    sum += weight * slope.dot(f - corner.cast<double>());
  }
  return sum / kDeviation;
}

// Hash of the nearest of the random points that stand one to a unit cube.
std::uint32_t cellAt(const Vector3d& p, std::uint32_t layer) {
  const Vector3i middle = floorOf(p);
  double nearest = 1e9;
  std::uint32_t owner = 0;
  for (int c = 0; c < 27; ++c) {
    const Vector3i node = middle + Vector3i(c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1);
    const std::uint32_t h = hash(node, layer);
    const double d = (node.cast<double>() + spread(h) - p).squaredNorm();
    if (d < nearest) nearest = d, owner = h;
  }
  return owner;
}

// A ball, light or dark, in every unit cube; 0 between them.
double speckAt(const Vector3d& p, std::uint32_t layer) {
  const Vector3i node = floorOf(p);
  const std::uint32_t h = hash(node, layer);
  const double radius = 0.2 + 0.25 * spread(h * 0x85ebca77U).x();
  const Vector3d center = Vector3d::Constant(radius) + (1 - 2 * radius) * spread(h);
  return (p - node.cast<double>() - center).norm() < radius ? signedTone(h) : 0;
}

}  // namespace

SolidTexture::SolidTexture(std::uint64_t seed) {
  std::uint32_t number = 0;
  const auto add = [&](std::vector<Layer>& layers, double size) {
    const Eigen::AngleAxisd turn(0.7 + 1.9 * ++number, Vector3d(0.36, 0.48, 0.8));
    const Eigen::AngleAxisd tilt(0.5 + 1.1 * number, Vector3d(0.8, -0.6, 0));
    const auto key = static_cast<std::uint32_t>(seed ^ seed >> 32) + 101 * number;
    layers.push_back(
        {size, (tilt * turn).toRotationMatrix() / size, Vector3d::Constant(17.31 * number), key});
  };
  for (int i = 0; i < kOctaves; ++i) add(octaves_, kCoarsest / (1 << i));
  for (const double size : kCellSizes) add(cells_, size);
  for (const double size : kSpeckSizes) add(specks_, size);
}

Vector3d SolidTexture::albedo(const Vector3d& point, double blur) const {
  double tone = 0;
  Vector3d paint = Vector3d::Zero();
  for (const Layer& layer : octaves_) {
    const double share = visibleShare(layer.size, blur);
    if (share > 0) tone += share * kOctaveContrast * gradientNoise(layer.inLattice(point), layer.key);
  }
  for (const Layer& layer : cells_) {
    const double share = visibleShare(layer.size, blur);
    if (share == 0) continue;
    const std::uint32_t cell = cellAt(layer.inLattice(point), layer.key);
    tone += share * kCellContrast * signedTone(cell);
    paint += share * kPaint * (2 * spread(cell) - Vector3d::Ones());
  }
  for (const Layer& layer : specks_) {
    const double share = visibleShare(0.8 * layer.size, blur);
    if (share > 0) tone += share * kSpeckContrast * speckAt(layer.inLattice(point), layer.key);
  }
  constexpr double kMiddle = 0.5, kRange = 0.42;
  const double grey = kMiddle + tone / std::sqrt(1 + tone * tone / (kRange * kRange));
  const Vector3d stone(1.06, 1.0, 0.9);
  const Vector3d color = grey * stone.array() * (1 + paint.array());
  return color.cwiseMax(0.05).cwiseMin(0.95);
}

}  // namespace vdbfuse::synth
