// SPDX-License-Identifier: Apache-2.0
#include "seen_surface.h"

#include <Eigen/Geometry>
#include <cmath>

namespace vdbfuse::synth {
namespace {

using Eigen::Vector3d;

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

// Up to scale, from four samples at the corners of a tetrahedron.
Vector3d gradient(const SignedDistance& distance, const Vector3d& at) {
  constexpr double kStep = 1e-5;
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& corner :
       {Vector3d(1, -1, -1), Vector3d(-1, -1, 1), Vector3d(-1, 1, -1), Vector3d(1, 1, 1)})
    sum += corner * distance(at + kStep * corner);
  return sum;
}

Vector3d triangleNormal(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vector3d a = mesh.vertices[t[0]].cast<double>();
  return (mesh.vertices[t[1]].cast<double>() - a).cross(mesh.vertices[t[2]].cast<double>() - a);
}

}  // namespace

Ray rayThrough(const ViewHeader& view, double x, double y) {
  const RigidTransform& pose = view.world_from_camera;
  return {pose.translation(), pose.linear() * unproject(view.projection, x, y, 1.0)};
}

SeenSurface::SeenSurface(const Scene& scene, Background background)
    : scene_(scene), background_(background), caster_(scene.truth) {}

std::optional<SeenPoint> SeenSurface::see(const Ray& ray) const {
  const std::optional<RayHit> hit = caster_.cast(ray.origin, ray.direction);
  if (hit)
    return SeenPoint{scene_.distance ? refined(scene_.distance, ray, hit->distance) : hit->distance,
                     hit->triangle};
  if (background_ == Background::Wall) return SeenPoint{wallDepth(ray), std::nullopt};
  return std::nullopt;
}

Vector3d SeenSurface::normal(const Ray& ray, const SeenPoint& seen) const {
  const Vector3d point = ray.at(seen.depth);
  const Vector3d any_length = !seen.triangle    ? point
                              : scene_.distance ? gradient(scene_.distance, point)
                                                : triangleNormal(scene_.truth, *seen.triangle);
  const Vector3d unit = any_length.normalized();
  return unit.dot(ray.direction) > 0 ? Vector3d(-unit) : unit;
}

}  // namespace vdbfuse::synth
