// SPDX-License-Identifier: Apache-2.0
#include "stereo/textured_planes.h"

#include <cmath>
#include <numbers>
#include <random>

#include "vdbfuse/geometry/look_at.h"

namespace vdbfuse::test {
namespace {

struct Wave {
  double s = 0, t = 0, phase = 0;
};

std::vector<Wave> wavesOf(int seed) {
  constexpr int kWaves = 30;
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    const double number = 2 * std::numbers::pi / std::pow(kFinestWave, uniform());
    const double angle = 2 * std::numbers::pi * uniform();
    waves.push_back({number * std::cos(angle), number * std::sin(angle), 2 * std::numbers::pi * uniform()});
  }
  return waves;
}

struct Hit {
  const TexturedRectangle* rectangle = nullptr;
  double z = INFINITY, s = 0, t = 0;
};

Hit nearestHit(const Rectangles& rectangles, const PhotographHeader& header, int x, int y) {
  const RigidTransform& pose = header.world_from_camera;
  const Eigen::Vector3d ray = pose.linear() * unproject(header.camera, x, y, 1);  // z grows by 1 along it
  Hit nearest;
  for (const TexturedRectangle& rectangle : rectangles) {
    const Eigen::Vector3d normal = rectangle.u.cross(rectangle.v);
    const double z = normal.dot(rectangle.origin - pose.translation()) / normal.dot(ray);
    const Eigen::Vector3d offset = pose.translation() + z * ray - rectangle.origin;
    const double s = offset.dot(rectangle.u), t = offset.dot(rectangle.v);
    if (z > 0 && z < nearest.z && std::abs(s) <= rectangle.half_u && std::abs(t) <= rectangle.half_v)
      nearest = {&rectangle, z, s, t};
  }
  return nearest;
}

double textureOf(const std::vector<Wave>& waves, double s, double t) {
  double sum = 0;
  for (const Wave& wave : waves) sum += std::sin(wave.s * s + wave.t * t + wave.phase);
  return 0.5 + 0.4 * std::tanh(sum / static_cast<double>(waves.size()) * 4);
}

}  // namespace

Image<float> depthOfRectangles(const Rectangles& rectangles, const PhotographHeader& header) {
  Image<float> depth(header.camera.width, header.camera.height);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const Hit hit = nearestHit(rectangles, header, x, y);
      if (hit.rectangle != nullptr) depth(x, y) = static_cast<float>(hit.z);
    }
  return depth;
}

Photograph photographOfRectangles(const Rectangles& rectangles, const PhotographHeader& header, double gain,
                                  double bias) {
  std::vector<std::vector<Wave>> waves;
  for (const TexturedRectangle& rectangle : rectangles) waves.push_back(wavesOf(rectangle.seed));
  Photograph photograph{header, Image<float>(header.camera.width, header.camera.height), {}, {}};
  for (int y = 0; y < header.camera.height; ++y)
    for (int x = 0; x < header.camera.width; ++x) {
      const Hit hit = nearestHit(rectangles, header, x, y);
      const double texture =
          hit.rectangle == nullptr
              ? 0
              : textureOf(waves[static_cast<std::size_t>(hit.rectangle - rectangles.data())], hit.s, hit.t);
      photograph.brightness(x, y) = static_cast<float>(gain * texture + bias);
    }
  return photograph;
}

std::vector<PhotographHeader> camerasOnArc(int count, double step_deg) {
  const Pinhole camera{96, 72, 125, 125, 47.5, 35.5, {}};
  std::vector<PhotographHeader> headers;
  for (int i = 0; i < count; ++i) {
    const double angle = (i - (count - 1) / 2.0) * step_deg * std::numbers::pi / 180;
    headers.push_back({"camera " + std::to_string(i), camera,
                       lookAt({2 * std::sin(angle), 0, -2 * std::cos(angle)}, {0, 0, 0}, {0, -1, 0})});
  }
  return headers;
}

}  // namespace vdbfuse::test
