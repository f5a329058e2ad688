// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solid_texture.h"
#include "vdbfuse/base/rows.h"

namespace vdbfuse::synth {
namespace {

using Eigen::Vector3d;

constexpr int kSubsamples = 3;  // a side of a pixel

// Directions to the lamps, and what each gives to a white surface that faces it.
struct Lights {
  explicit Lights(const Scene& scene)
      : up(scene.up),
        lamp((scene.front + 0.7 * scene.up + 0.6 * scene.front.cross(scene.up)).normalized()),
        back_lamp((-scene.front + 0.3 * scene.up + 0.8 * scene.front.cross(scene.up)).normalized()) {}

  Vector3d up, lamp, back_lamp;

  double diffuse(const Vector3d& normal) const {
    return 0.48 + 0.12 * normal.dot(up) + 0.5 * std::max(0.0, normal.dot(lamp)) +
           0.35 * std::max(0.0, normal.dot(back_lamp));
  }
  // Blinn's highlight of the lamp.
  double highlight(const Vector3d& normal, const Vector3d& to_eye) const {
    constexpr double kSharpness = 30;
    return std::pow(std::max(0.0, normal.dot((lamp + to_eye).normalized())), kSharpness);
  }
};

struct Camera {
  const ViewHeader& view;
  const SeenSurface& surface;
  const PhotographOptions& options;
  SolidTexture texture;
  Lights lights;

  // The share of light, in red, green and blue, that comes from where the ray leads.
  Vector3d light(const Ray& ray) const {
    const std::optional<SeenPoint> seen = surface.see(ray);
    if (!seen) return Vector3d::Zero();
    const Vector3d normal = surface.normal(ray, *seen), to_eye = -ray.direction.normalized();
    // The blur of a pixel; along the slant of the surface, that of the distance between two subsamples.
    const double slant = std::max(0.05, normal.dot(to_eye));
    const double blur = footprint(view.projection, seen->depth) * std::max(1.0, 2.0 / (kSubsamples * slant));
    const Vector3d albedo = texture.albedo(ray.at(seen->depth), blur);
    if (!seen->triangle) return 0.6 * albedo;
    return albedo * lights.diffuse(normal) +
           Vector3d::Constant(options.gloss * lights.highlight(normal, to_eye));
  }

  Vector3d pixel(int x, int y) const {
    Vector3d sum = Vector3d::Zero();
    const auto offset = [](int i) { return (i + 0.5) / kSubsamples - 0.5; };
    for (int v = 0; v < kSubsamples; ++v)
      for (int u = 0; u < kSubsamples; ++u) sum += light(rayThrough(view, x + offset(u), y + offset(v)));
    return sum / (kSubsamples * kSubsamples);
  }
};

Image<Vector3d> expose(const Camera& camera) {
  Image<Vector3d> light(imageWidth(camera.view.projection), imageHeight(camera.view.projection),
                        Vector3d::Zero());
  forEachRow(light.height(), 8, [&](int y) {
    for (int x = 0; x < light.width(); ++x) light(x, y) = camera.pixel(x, y);
  });
  return light;
}

}  // namespace

Image<Rgb8> takePicture(const ViewHeader& view, const Scene& scene, const SeenSurface& surface,
                        const PhotographOptions& options, std::uint64_t seed, Random random) {
  const Image<Vector3d> light = expose({view, surface, options, SolidTexture(seed), Lights(scene)});
  constexpr double kWhite = 255;
  const double gain = kWhite * std::pow(options.gain, random.uniform(-1, 1));
  const double bias = random.uniform(-1, 1) * options.bias;
  Image<Rgb8> picture(light.width(), light.height());
  for (std::size_t i = 0; i < picture.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double level = gain * light.data()[i][static_cast<int>(c)] + bias;
      const double noisy = level + (options.noise > 0 ? options.noise * random.normal() : 0);
      picture.data()[i][c] = static_cast<std::uint8_t>(std::lround(std::clamp(noisy, 0.0, kWhite)));
    }
  }
  return picture;
}

}  // namespace vdbfuse::synth
