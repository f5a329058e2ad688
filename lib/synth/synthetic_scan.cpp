// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/synth/synthetic_scan.h"

#include <cmath>

#include "cameras.h"
#include "mistakes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mesh/ray_caster.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

std::string joined(const std::vector<std::string>& sentences) {
  std::string all;
  for (const std::string& s : sentences) all += (all.empty() ? "" : "; ") + s;
  return all;
}

const SynthOptions& checked(const SynthOptions& options) {
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw InvalidArgument("options", joined(problems));
  return options;
}

struct Ray {
  Vector3d origin, direction;  // direction has z = 1 in the camera: lengths along it are depths
  Vector3d at(double depth) const { return origin + depth * direction; }
};

// Root of f between `outside` (f > 0) and `inside` (f < 0), by the Illinois variant of false position.
template <class F>
double rootBetween(const F& f, double outside, double inside) {
  constexpr double kExact = 1e-9;
  constexpr int kSteps = 40;
  double f_outside = f(outside), f_inside = f(inside);
  int last_side = 0;
  double root = inside;
  for (int i = 0; i < kSteps && std::abs(inside - outside) > kExact; ++i) {
    root = (outside * f_inside - inside * f_outside) / (f_inside - f_outside);
    const double value = f(root);
    if (std::abs(value) < kExact) break;
    const int side = value > 0 ? 1 : -1;
    (side > 0 ? outside : inside) = root;
    (side > 0 ? f_outside : f_inside) = value;
    if (side == last_side) (side > 0 ? f_inside : f_outside) *= 0.5;
    last_side = side;
  }
  return root;
}

// Moves a hit on the mesh onto the surface that the mesh stands for; keeps the mesh's answer where the ray
// finds no change of sign close by, because it only grazes the surface.
double refined(const SignedDistance& distance, const Ray& ray, double hit) {
  const double reach = 0.01 / ray.direction.norm();
  const auto f = [&](double depth) { return distance(ray.at(depth)); };
  const double at_hit = f(hit);
  if (at_hit > 0) return f(hit + reach) < 0 ? rootBetween(f, hit, hit + reach) : hit;
  return f(hit - reach) > 0 ? rootBetween(f, hit - reach, hit) : hit;
}

// Depth at which a ray that starts inside leaves the sphere of the background.
double wallDepth(const Ray& ray) {
  const double a = ray.direction.squaredNorm(), b = ray.origin.dot(ray.direction);
  const double c = ray.origin.squaredNorm() - kWallRadius * kWallRadius;
  return (-b + std::sqrt(b * b - a * c)) / a;
}

}  // namespace

struct SyntheticScan::Impl {
  Impl(Scene s, const SynthOptions& o)
      : options(checked(o)),
        scene(o.arc == Arc::Room ? inRoom(std::move(s)) : std::move(s)),
        headers(synth::placeCameras(scene, o)),
        caster(scene.truth) {}

  SynthOptions options;
  Scene scene;
  std::vector<ViewHeader> headers;
  RayCaster caster;

  void renderRow(SyntheticView& view, int y) const {
    const RigidTransform& pose = view.view.world_from_camera;
    for (int x = 0; x < view.true_depth.width(); ++x) {
      const Ray ray{pose.translation(), pose.linear() * unproject(view.view.projection, x, y, 1.0)};
      const std::optional<RayHit> hit = caster.cast(ray.origin, ray.direction);
      view.object(x, y) = hit ? 1 : 0;
      if (hit) {
        const double depth = scene.distance ? refined(scene.distance, ray, hit->distance) : hit->distance;
        view.true_depth(x, y) = static_cast<float>(depth);
      } else if (options.background == Background::Wall) {
        view.true_depth(x, y) = static_cast<float>(wallDepth(ray));
      }
    }
  }

  SyntheticView render(std::size_t index) const {
    SyntheticView result;
    static_cast<ViewHeader&>(result.view) = headers[index];
    result.true_depth = Image<float>(options.width, options.height, kInvalidDepth);
    result.object = Image<std::uint8_t>(options.width, options.height);
    parallelFor(static_cast<std::size_t>(options.height), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) renderRow(result, static_cast<int>(y));
    });
    synth::measure(result, options, Random(options.seed, index));
    return result;
  }
};

SyntheticScan::SyntheticScan(Scene scene, const SynthOptions& options)
    : impl_(std::make_shared<const Impl>(std::move(scene), options)) {}

std::size_t SyntheticScan::size() const { return impl_->headers.size(); }
const Scene& SyntheticScan::scene() const { return impl_->scene; }
const SynthOptions& SyntheticScan::options() const { return impl_->options; }
const ViewHeader& SyntheticScan::header(std::size_t index) const { return impl_->headers[index]; }
SyntheticView SyntheticScan::render(std::size_t index) const { return impl_->render(index); }

ViewSequence SyntheticScan::views() const {
  return {impl_->headers, [impl = impl_](std::size_t index) { return impl->render(index).view.map; }};
}

std::vector<SyntheticView> renderAll(const SyntheticScan& scan, const Progress& progress) {
  std::vector<SyntheticView> views(scan.size());
  ProgressStep step(progress, "scanning", scan.size());
  parallelFor(scan.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      views[i] = scan.render(i);
      step.advance();
    }
  });
  return views;
}

ScanStatistics& operator+=(ScanStatistics& sum, const ScanStatistics& other) {
  sum.pixels += other.pixels;
  sum.object_pixels += other.object_pixels;
  sum.object_measured += other.object_measured;
  sum.object_wrong += other.object_wrong;
  sum.background_measured += other.background_measured;
  sum.background_wrong += other.background_wrong;
  return sum;
}

ScanStatistics statistics(const SyntheticView& view) {
  ScanStatistics s;
  s.pixels = view.object.size();
  for (std::size_t i = 0; i < view.object.size(); ++i) {
    const bool object = view.object.data()[i] != 0, wrong = view.mistake.data()[i] != 0;
    const bool measured = view.view.map.depth.data()[i] > 0;
    s.object_pixels += object ? 1 : 0;
    (object ? s.object_measured : s.background_measured) += measured ? 1 : 0;
    (object ? s.object_wrong : s.background_wrong) += wrong ? 1 : 0;
  }
  return s;
}

}  // namespace vdbfuse
