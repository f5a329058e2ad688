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

// What a ray hits: z, where in the texture, and whose texture.
struct Hit {
  double z = INFINITY, s = 0, t = 0;
  std::size_t texture = 0;
};

// z grows by 1 along `direction`.
struct Ray {
  Eigen::Vector3d eye, direction;
  Eigen::Vector3d at(double z) const { return eye + z * direction; }
};

Hit hitOf(const TexturedRectangle& rectangle, const Ray& ray) {
  const Eigen::Vector3d normal = rectangle.u.cross(rectangle.v);
  const double z = normal.dot(rectangle.origin - ray.eye) / normal.dot(ray.direction);
  const Eigen::Vector3d offset = ray.at(z) - rectangle.origin;
  const double s = offset.dot(rectangle.u), t = offset.dot(rectangle.v);
  const bool is_hit = z > 0 && std::abs(s) <= rectangle.half_u && std::abs(t) <= rectangle.half_v;
  return is_hit ? Hit{z, s, t} : Hit{};
}

Hit hitOf(const TexturedSphere& sphere, const Ray& ray) {
  const Eigen::Vector3d to_middle = sphere.middle - ray.eye;
  const double square = ray.direction.squaredNorm(), along = ray.direction.dot(to_middle) / square;
  const double half2 = along * along - (to_middle.squaredNorm() - sphere.radius * sphere.radius) / square;
  if (!(half2 >= 0)) return {};
  const double z = along - std::sqrt(half2);
  const Eigen::Vector3d offset = ray.at(z) - sphere.middle;
  return z > 0 ? Hit{z, offset.x() + 0.6 * offset.z(), offset.y() + 0.4 * offset.z()} : Hit{};
}

// Textures are numbered through the rectangles first.
Hit nearestHit(const TexturedScene& scene, const PhotographHeader& header, int x, int y) {
  const RigidTransform& pose = header.world_from_camera;
  const Ray ray{pose.translation(), pose.linear() * unproject(header.camera, x, y, 1)};
  Hit nearest;
  std::size_t texture = 0;
  const auto consider = [&](const auto& shape) {
    const Hit hit = hitOf(shape, ray);
    if (hit.z < nearest.z) nearest = hit, nearest.texture = texture;
    ++texture;
  };
  for (const TexturedRectangle& rectangle : scene.rectangles) consider(rectangle);
  for (const TexturedSphere& sphere : scene.spheres) consider(sphere);
  return nearest;
}

double textureOf(const std::vector<Wave>& waves, double s, double t) {
  double sum = 0;
  for (const Wave& wave : waves) sum += std::sin(wave.s * s + wave.t * t + wave.phase);
  return 0.5 + 0.4 * std::tanh(sum / static_cast<double>(waves.size()) * 4);
}

}  // namespace

Image<float> trueDepthOf(const TexturedScene& scene, const PhotographHeader& header) {
  Image<float> depth(header.camera.width, header.camera.height);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      const Hit hit = nearestHit(scene, header, x, y);
      if (std::isfinite(hit.z)) depth(x, y) = static_cast<float>(hit.z);
    }
  return depth;
}

Photograph photographOf(const TexturedScene& scene, const PhotographHeader& header, double gain,
                        double bias) {
  std::vector<std::vector<Wave>> waves;
  for (const TexturedRectangle& rectangle : scene.rectangles) waves.push_back(wavesOf(rectangle.seed));
  for (const TexturedSphere& sphere : scene.spheres) waves.push_back(wavesOf(sphere.seed));
  Photograph photograph{header, Image<float>(header.camera.width, header.camera.height), {}, {}};
  for (int y = 0; y < header.camera.height; ++y)
    for (int x = 0; x < header.camera.width; ++x) {
      const Hit hit = nearestHit(scene, header, x, y);
      const double texture = std::isfinite(hit.z) ? textureOf(waves[hit.texture], hit.s, hit.t) : 0;
      photograph.brightness(x, y) = static_cast<float>(gain * texture + bias);
    }
  return photograph;
}

std::vector<Photograph> photographsOf(const TexturedScene& scene,
                                      const std::vector<PhotographHeader>& headers) {
  std::vector<Photograph> photographs;
  for (const PhotographHeader& header : headers) photographs.push_back(photographOf(scene, header));
  return photographs;
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
