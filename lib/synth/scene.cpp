// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/synth/scene.h"

#include <algorithm>

#include "distance_mesh.h"
#include "shapes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

// scaled = (native − center) · scale
struct ToUnit {
  Vector3d center;
  double scale;

  Vector3d operator()(const Vector3d& p) const { return (p - center) * scale; }
  SceneRegionShape operator()(const SceneRegionShape& shape) const {
    struct Visit {
      const ToUnit& to;
      SceneRegionShape operator()(const Box& b) const { return Box(to(b.min()), to(b.max())); }
      SceneRegionShape operator()(const CylinderShape& c) const {
        return CylinderShape{to(c.from), to(c.to), c.radius * to.scale};
      }
      SceneRegionShape operator()(const SphereShape& s) const {
        return SphereShape{to(s.center), s.radius * to.scale};
      }
    };
    return std::visit(Visit{*this}, shape);
  }
};

ToUnit toUnit(const Box& bounds) { return {bounds.center(), 1.0 / bounds.diagonal().norm()}; }

struct Contains {
  const Vector3d& point;
  bool operator()(const Box& b) const { return b.contains(point); }
  bool operator()(const CylinderShape& c) const {
    const Vector3d axis = c.to - c.from;
    const double t = (point - c.from).dot(axis) / axis.squaredNorm();
    return t >= 0 && t <= 1 && (point - c.from - t * axis).norm() <= c.radius;
  }
  bool operator()(const SphereShape& s) const { return (point - s.center).norm() <= s.radius; }
};

enum class Facing { Outward, Inward };

// Appends the twelve triangles of a box.
void addBox(TriangleMesh& mesh, const Box& box, Facing facing) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int c = 0; c < 8; ++c)
    mesh.vertices.push_back(box.corner(static_cast<Box::CornerType>(c)).cast<float>());
  constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    for (Triangle t : {Triangle{f[0], f[1], f[2]}, Triangle{f[0], f[2], f[3]}}) {
      if (facing == Facing::Inward) std::swap(t[1], t[2]);
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
}

}  // namespace

bool contains(const SceneRegionShape& shape, const Vector3d& point) {
  return std::visit(Contains{point}, shape);
}

std::vector<std::string> sceneNames() { return {"sphere", "box", "torus", "figure", "occluder", "ball"}; }

Scene makeScene(const std::string& name, const SceneOptions& options) {
  if (!(options.cell > 0)) throw InvalidArgument("cell", "must be positive");
  const std::optional<synth::Shape> shape = synth::shapeNamed(name);
  if (!shape) throw InvalidArgument("scene", "unknown name '" + name + "'");
  ToUnit unit = toUnit(shape->bounds);
  if (name == "ball") unit.scale = 1.0 / shape->bounds.sizes().x();
  Scene scene;
  scene.name = name;
  scene.distance = [unit, native = shape->distance](const Vector3d& p) {
    return unit.scale * native(p / unit.scale + unit.center);
  };
  const Box bounds(unit(shape->bounds.min()), unit(shape->bounds.max()));
  scene.truth = synth::meshFromDistance(scene.distance, bounds, options.cell);
  for (const SceneRegion& r : shape->regions) scene.regions.push_back({r.name, r.expect, unit(r.shape)});
  return scene;
}

Scene sceneFromMesh(std::string name, TriangleMesh mesh) {
  if (mesh.triangles.empty()) throw InvalidArgument("mesh", "has no triangles");
  const ToUnit unit = toUnit(boundingBox(mesh));
  if (!std::isfinite(unit.scale))
    throw InvalidArgument("mesh", "has no extent, or vertices that are not finite");
  for (Eigen::Vector3f& v : mesh.vertices) v = unit(v.cast<double>()).cast<float>();
  Scene scene;
  scene.name = std::move(name);
  scene.truth = std::move(mesh);
  return scene;
}

Scene inRoom(Scene object) {
  const Vector3d outer = kRoomHalfSize + Vector3d::Constant(kRoomWall);
  object.truth.normals.clear(), object.truth.colors.clear(), object.truth.support.clear();
  addBox(object.truth, Box(-kRoomHalfSize, kRoomHalfSize), Facing::Inward);
  addBox(object.truth, Box(-outer, outer), Facing::Outward);
  const Vector3d side{0.3, 0.8, 0.8};
  const Vector3d center{1.1, 0, 0};
  object.regions.push_back({"free space", RegionSide::Outside, Box(center - side, center + side)});
  if (!object.distance) return object;
  object.distance = [inner = std::move(object.distance), outer](const Vector3d& p) {
    const double wall = std::max(-synth::boxDistance(p, Vector3d::Zero(), kRoomHalfSize),
                                 synth::boxDistance(p, Vector3d::Zero(), outer));
    return std::min(inner(p), wall);
  };
  return object;
}

}  // namespace vdbfuse
