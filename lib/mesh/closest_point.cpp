// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <flann/flann.hpp>
#include <limits>
#include <optional>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

// A triangle, or a piece of one, in the index.
struct Piece {
  Vector3d a, b, c;
  std::uint32_t triangle;

  Vector3d centroid() const { return (a + b + c) / 3; }
  double radius() const {
    const Vector3d m = centroid();
    return std::sqrt(std::max({(a - m).squaredNorm(), (b - m).squaredNorm(), (c - m).squaredNorm()}));
  }
};

std::vector<Piece> finiteTriangles(const TriangleMesh& mesh) {
  std::vector<Piece> pieces;
  pieces.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const Piece piece{mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
                      mesh.vertices[t[2]].cast<double>(), i};
    if (piece.a.allFinite() && piece.b.allFinite() && piece.c.allFinite()) pieces.push_back(piece);
  }
  return pieces;
}

// Halves across the longest edge.
std::pair<Piece, Piece> halves(const Piece& p) {
  const double ab = (p.b - p.a).squaredNorm(), bc = (p.c - p.b).squaredNorm(), ca = (p.a - p.c).squaredNorm();
  if (ab >= bc && ab >= ca) {
    const Vector3d m = (p.a + p.b) / 2;
    return {{p.a, m, p.c, p.triangle}, {m, p.b, p.c, p.triangle}};
  }
  if (bc >= ca) {
    const Vector3d m = (p.b + p.c) / 2;
    return {{p.a, p.b, m, p.triangle}, {p.a, m, p.c, p.triangle}};
  }
  const Vector3d m = (p.c + p.a) / 2;
  return {{p.a, p.b, m, p.triangle}, {m, p.b, p.c, p.triangle}};
}

struct Centroids {
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> triangles;
};

// Nothing when more than `limit` pieces would be needed.
std::optional<Centroids> splitTo(double radius, const std::vector<Piece>& pieces, std::size_t limit) {
  Centroids result;
  std::vector<Piece> open;
  for (const Piece& whole : pieces) {
    open.push_back(whole);
    while (!open.empty()) {
      const Piece piece = open.back();
      open.pop_back();
      if (result.points.size() + open.size() >= limit) return std::nullopt;
      if (piece.radius() <= radius) {
        result.points.push_back(piece.centroid());
        result.triangles.push_back(piece.triangle);
        continue;
      }
      const auto [one, other] = halves(piece);
      open.push_back(other);
      open.push_back(one);
    }
  }
  return result;
}

// A radius that most triangles of an even mesh keep unsplit.
double firstRadius(const std::vector<Piece>& pieces) {
  constexpr double kFewest = 4096;
  double total = 0;
  for (const Piece& p : pieces) total += 0.5 * (p.b - p.a).cross(p.c - p.a).norm();
  return 1.5 * std::sqrt(total / std::max(kFewest, static_cast<double>(pieces.size())));
}

struct Surface {
  std::vector<Piece> triangles;   // whole, each with its number in the mesh
  std::vector<Vector3d> normals;  // unit, or zero for a triangle without area
  Centroids centroids;            // of pieces, each with its place in `triangles`
  double reach = 0;               // of a piece from its centroid, at most: R
};

Surface surfaceOf(const TriangleMesh& mesh) {
  Surface surface;
  surface.triangles = finiteTriangles(mesh);
  for (const Piece& t : surface.triangles)
    surface.normals.push_back((t.b - t.a).cross(t.c - t.a).stableNormalized());
  std::vector<Piece> pieces = surface.triangles;
  for (std::uint32_t i = 0; i < pieces.size(); ++i) pieces[i].triangle = i;
  const std::size_t limit = 4 * pieces.size() + 65536;
  for (surface.reach = firstRadius(pieces);; surface.reach = 2 * surface.reach + 1e-30) {
    if (auto split = splitTo(surface.reach, pieces, limit)) {
      surface.centroids = std::move(*split);
      return surface;
    }
  }
}

// Collects for FLANN's search not the nearest centroid, but the nearest point of the triangles it comes by.
class NearestTriangle : public flann::ResultSet<double> {
 public:
  NearestTriangle(const Vector3d& query, const Surface& surface)
      : query_(query),
        triangles_(surface.triangles),
        normals_(surface.normals),
        owner_(surface.centroids.triangles),
        reach_(surface.reach) {}

  bool full() const override { return true; }
  double worstDist() const override { return worst_; }
  void addPoint(double squared, std::size_t index) override {
    const std::uint32_t triangle = owner_[index];
    // FLANN compares with the bound it had when it entered the leaf.
    if (triangle == last_ || squared >= worst_) return;
    last_ = triangle;
    const Piece& t = triangles_[triangle];
    // Its plane is further away than the best point: true for most candidates inside of something round.
    if (std::abs(normals_[triangle].dot(query_ - t.a)) > best_.distance * (1 + 1e-9)) return;
    const Vector3d point = closestPointOnTriangle(query_, t.a, t.b, t.c);
    const double distance = (point - query_).norm();
    if (distance >= best_.distance) return;
    best_ = {distance, point, t.triangle};
    // A little more than u + R, for what rounding takes away.
    worst_ = std::pow((distance + reach_) * (1 + 1e-9), 2);
  }
  const SurfacePoint& best() const { return best_; }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Vector3d& query_;
  const std::vector<Piece>& triangles_;
  const std::vector<Vector3d>& normals_;
  const std::vector<std::uint32_t>& owner_;
  double reach_;
  double worst_ = kInfinity;
  std::uint32_t last_ = std::numeric_limits<std::uint32_t>::max();
  SurfacePoint best_{kInfinity, Vector3d::Zero(), 0};
};

Vector3d closestPointOnSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return a + t * along;
}

}  // namespace

Vector3d closestPointOnTriangle(const Vector3d& point, const Vector3d& a, const Vector3d& b,
                                const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  if (area2 > 0) {
    const double on_b = (point - a).cross(c - a).dot(normal) / area2;
    const double on_c = (b - a).cross(point - a).dot(normal) / area2;
    if (on_b >= 0 && on_c >= 0 && on_b + on_c <= 1) return a + on_b * (b - a) + on_c * (c - a);
  }
  Vector3d nearest = closestPointOnSegment(point, a, b);
  for (const Vector3d& other : {closestPointOnSegment(point, b, c), closestPointOnSegment(point, c, a)}) {
    if ((other - point).squaredNorm() < (nearest - point).squaredNorm()) nearest = other;
  }
  return nearest;
}

struct ClosestPoint::Impl {
  Surface surface;
  std::unique_ptr<flann::KDTreeSingleIndex<flann::L2_3D<double>>> tree;
};

ClosestPoint::ClosestPoint(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->surface = surfaceOf(mesh);
  std::vector<Vector3d>& points = impl_->surface.centroids.points;
  if (points.empty()) return;
  const flann::Matrix<double> data(points.front().data(), points.size(), 3);
  impl_->tree = std::make_unique<flann::KDTreeSingleIndex<flann::L2_3D<double>>>(
      data, flann::KDTreeSingleIndexParams());
  impl_->tree->buildIndex();
}

ClosestPoint::~ClosestPoint() = default;
ClosestPoint::ClosestPoint(ClosestPoint&&) noexcept = default;
ClosestPoint& ClosestPoint::operator=(ClosestPoint&&) noexcept = default;

SurfacePoint ClosestPoint::query(const Vector3d& point) const {
  NearestTriangle nearest(point, impl_->surface);
  if (impl_->tree) impl_->tree->findNeighbors(nearest, point.data(), flann::SearchParams());
  return nearest.best();
}

std::vector<float> vertexDistances(const TriangleMesh& mesh, const ClosestPoint& surface) {
  std::vector<float> distances(mesh.vertices.size());
  parallelFor(distances.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      distances[i] = static_cast<float>(surface.query(mesh.vertices[i].cast<double>()).distance);
  });
  return distances;
}

}  // namespace vdbfuse
