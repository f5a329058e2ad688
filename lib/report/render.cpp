// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/mesh/ray_caster.h"
#include "vdbfuse/report/color_map.h"

namespace vdbfuse {
namespace {

using Color = Eigen::Array3d;  // 0 to 255
using Eigen::Vector3d;

const Color kClay{208, 202, 190}, kInnerSide{150, 90, 200}, kInvented{240, 120, 20};
constexpr double kHeadlight = 0.8, kSky = 0.5;  // together a bit over 1: what faces both comes out white

Color toColor(const Rgb8& rgb) { return {double(rgb[0]), double(rgb[1]), double(rgb[2])}; }

Rgb8 toRgb(const Color& color) {
  Rgb8 rgb;
  for (int c = 0; c < 3; ++c)
    rgb[c] = static_cast<std::uint8_t>(std::lround(std::clamp(color[c], 0.0, 255.0)));
  return rgb;
}

struct Range {
  double low, high;
  double position(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

Range colorRange(const RenderOptions& options, const std::vector<float>& values) {
  if (options.high > options.low || values.empty()) return {options.low, options.high};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

// All that a ray needs.
class Painter {
 public:
  Painter(const TriangleMesh& mesh, const ViewHeader& view, const RenderOptions& options)
      : mesh_(mesh),
        view_(view),
        options_(options),
        values_(options.coloring == MeshColoring::Support ? mesh.support : options.values),
        range_(colorRange(options, values_)),
        normals_(vertexNormals(mesh)),
        caster_(mesh) {}

  Color pixel(int x, int y) const {
    const int n = options_.supersampling;
    Color sum = Color::Zero();
    for (int v = 0; v < n; ++v)
      for (int u = 0; u < n; ++u) sum += sample(x + (u + 0.5) / n - 0.5, y + (v + 0.5) / n - 0.5);
    return sum / (n * n);
  }

 private:
  Color sample(double x, double y) const {
    const Vector3d from = unproject(view_.projection, x, y, 0.0), to = unproject(view_.projection, x, y, 1.0);
    const Vector3d origin = view_.world_from_camera * from;
    const Vector3d direction = view_.world_from_camera.linear() * (to - from).normalized();
    const std::optional<RayHit> hit = caster_.cast(origin, direction);
    return hit ? surfaceColor(*hit, direction) : toColor(options_.background);
  }

  Color surfaceColor(const RayHit& hit, const Vector3d& direction) const {
    const Vector3d face = faceNormal(hit);
    const bool inner = face.dot(direction) > 0;
    Vector3d normal = options_.normals == RenderOptions::Normals::Flat ? face : smoothNormal(hit, face);
    if (inner) normal = -normal;
    if (options_.coloring == MeshColoring::Normal) return normalColor(normal);
    const double facing = std::max(0.0, -normal.dot(direction));
    const double light = kHeadlight * facing + kSky * 0.5 * (1 + normal.dot(options_.up.normalized()));
    return light * (inner ? kInnerSide : baseColor(hit));
  }

  Color normalColor(const Vector3d& normal) const {
    // y and z point the other way in a picture's usual colours: up is green, towards the viewer blue.
    const Vector3d n = view_.world_from_camera.linear().transpose() * normal;
    return 127.5 * (1 + Eigen::Array3d(n.x(), -n.y(), -n.z()));
  }

  Color baseColor(const RayHit& hit) const {
    if (options_.coloring == MeshColoring::Vertex) {
      const auto& [a, b, c] = mesh_.triangles[hit.triangle];
      return (1 - hit.u - hit.v) * toColor(mesh_.colors[a]) + hit.u * toColor(mesh_.colors[b]) +
             hit.v * toColor(mesh_.colors[c]);
    }
    if (values_.empty()) return kClay;
    const double value = interpolated(hit, values_);
    if (options_.coloring == MeshColoring::Support) {
      constexpr double kNoView = 0.5;
      if (value < kNoView) return kInvented;
      return toColor(sequentialColor(range_.high > 0 ? value / range_.high : 1));
    }
    return toColor(sequentialColor(range_.position(value)));
  }

  template <class Values>
  typename Values::value_type interpolated(const RayHit& hit, const Values& values) const {
    const auto& [a, b, c] = mesh_.triangles[hit.triangle];
    const auto u = static_cast<float>(hit.u), v = static_cast<float>(hit.v);
    return typename Values::value_type((1 - u - v) * values[a] + u * values[b] + v * values[c]);
  }

  Vector3d faceNormal(const RayHit& hit) const {
    const auto& [a, b, c] = mesh_.triangles[hit.triangle];
    const Vector3d p = mesh_.vertices[a].cast<double>();
    return (mesh_.vertices[b].cast<double>() - p).cross(mesh_.vertices[c].cast<double>() - p).normalized();
  }

  Vector3d smoothNormal(const RayHit& hit, const Vector3d& face) const {
    const Vector3d normal = interpolated(hit, normals_).template cast<double>();
    return normal.squaredNorm() > 0 ? Vector3d(normal.normalized()) : face;
  }

  const TriangleMesh& mesh_;
  const ViewHeader& view_;
  const RenderOptions& options_;
  const std::vector<float>& values_;
  Range range_;
  std::vector<Eigen::Vector3f> normals_;
  RayCaster caster_;
};

void check(const RenderOptions& options, const TriangleMesh& mesh, const ViewHeader& view) {
  std::string all;
  for (const std::string& problem : validate(options, mesh)) all += (all.empty() ? "" : "; ") + problem;
  if (!all.empty()) throw InvalidArgument("options", all);
  for (const std::string& problem : validate(view.projection)) throw InvalidArgument("view", problem);
}

}  // namespace

std::vector<std::string> validate(const RenderOptions& options, const TriangleMesh& mesh) {
  std::vector<std::string> problems;
  const auto require = [&](bool good, const char* sentence) {
    if (!good) problems.emplace_back(sentence);
  };
  constexpr int kMost = 16;
  require(options.supersampling >= 1 && options.supersampling <= kMost, "supersampling must lie in 1 … 16");
  require(options.up.norm() > 0, "up must not be zero");
  require(options.coloring != MeshColoring::Support || mesh.support.size() == mesh.vertices.size(),
          "the mesh carries no support");
  require(options.coloring != MeshColoring::Vertex || mesh.colors.size() == mesh.vertices.size(),
          "the mesh carries no colours");
  require(options.coloring != MeshColoring::Values || options.values.size() == mesh.vertices.size(),
          "there must be one value a vertex");
  return problems;
}

Image<Rgb8> render(const TriangleMesh& mesh, const ViewHeader& view, const RenderOptions& options) {
  check(options, mesh, view);
  const Painter painter(mesh, view, options);
  Image<Rgb8> picture(imageWidth(view.projection), imageHeight(view.projection));
  parallelFor(static_cast<std::size_t>(picture.height()), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < picture.width(); ++x) picture(x, y) = toRgb(painter.pixel(x, y));
  });
  return picture;
}

ViewHeader cameraLookingAt(const Vector3d& eye, const Vector3d& target, const Vector3d& up, int width,
                           int height) {
  constexpr double kHalfView = 0.36397;  // tan 20°
  Pinhole camera{.width = width, .height = height};
  camera.fx = camera.fy = 0.5 * std::max(width, height) / kHalfView;
  camera.cx = 0.5 * (width - 1), camera.cy = 0.5 * (height - 1);
  return {"", camera, lookAt(eye, target, up)};
}

ViewHeader framingCamera(const TriangleMesh& mesh, const Vector3d& up, int width, int height) {
  return framingCamera(mesh, up, width, height, 0);
}

ViewHeader framingCamera(const TriangleMesh& mesh, const Vector3d& up, int width, int height, double angle) {
  constexpr double kMargin = 1.06;
  const Vector3d center = boundingBox(mesh).center(), front = frontFor(up), right = up.cross(front);
  const Vector3d direction = Eigen::AngleAxisd(angle, up) * (front + 0.6 * right + 0.35 * up).normalized();
  ViewHeader view = cameraLookingAt(center + direction, center, up, width, height);
  const auto& camera = std::get<Pinhole>(view.projection);
  // As near as all vertices allow.
  double distance = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3d p = view.world_from_camera.linear().transpose() * (vertex.cast<double>() - center);
    const double x = 2 * camera.fx / width * std::abs(p.x()), y = 2 * camera.fy / height * std::abs(p.y());
    distance = std::max(distance, kMargin * std::max(x, y) - p.z());
  }
  view.world_from_camera.translation() = center + distance * direction;
  return view;
}

Image<Rgb8> renderTurntable(const TriangleMesh& mesh, int count, int width, int height,
                            const RenderOptions& options) {
  const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
  Image<Rgb8> sheet(columns * width, rows * height, options.background);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    const Image<Rgb8> picture = render(mesh, framingCamera(mesh, options.up, width, height, angle), options);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        sheet(k % columns * width + x, k / columns * height + y) = picture(x, y);
  }
  return sheet;
}

}  // namespace vdbfuse
