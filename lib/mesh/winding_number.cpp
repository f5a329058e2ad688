// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/winding_number.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr std::uint32_t kLeafSize = 8;
constexpr double kFullSphere = 4 * std::numbers::pi;

using Corners = std::array<Vector3f, 3>;

Vector3f sumOf(const Corners& t) { return t[0] + t[1] + t[2]; }

// Nodes lie in preorder: the first child follows its parent, `skip` is the node after the whole subtree. A
// subtree owns the triangles [begin, end).
struct Node {
  Vector3d center;      // weighted by area, which makes the next term of the expansion small
  Vector3d dipole;      // sum of the normals n, each as long as the area
  Matrix3d quadrupole;  // sum of (centroid − center) nᵀ
  double near_squared;  // closer than that, the dipole is not good enough
  std::uint32_t begin, end, skip;
  bool isLeaf() const { return end - begin <= kLeafSize; }
};

struct Moment {
  Vector3d centroid, normal;
};

Moment momentOf(const Corners& t) {
  const Vector3d a = t[0].cast<double>(), b = t[1].cast<double>(), c = t[2].cast<double>();
  return {(a + b + c) / 3, 0.5 * (b - a).cross(c - a)};
}

// The solid angle of a node's triangles to second order: the Taylor expansion of the field r / |r|³ at its
// center.
double farAngle(const Node& node, const Vector3d& r, double r_squared) {
  const double r_cubed = r_squared * std::sqrt(r_squared);
  const double second = node.quadrupole.trace() - 3 * r.dot(node.quadrupole * r) / r_squared;
  return (node.dipole.dot(r) + second) / r_cubed;
}

class TreeBuilder {
 public:
  TreeBuilder(std::vector<Corners>& triangles, double accuracy)
      : triangles_(triangles), accuracy_(accuracy) {}

  std::vector<Node> build() {
    if (!triangles_.empty()) add(0, static_cast<std::uint32_t>(triangles_.size()));
    return std::move(nodes_);
  }

 private:
  // Depth is log2 of the number of triangles: halves differ by at most one.
  void add(std::uint32_t begin, std::uint32_t end) {
    const std::size_t self = nodes_.size();
    nodes_.push_back(summary(begin, end));
    if (!nodes_[self].isLeaf()) {
      const std::uint32_t middle = splitInHalves(begin, end);
      add(begin, middle);
      add(middle, end);
    }
    nodes_[self].skip = static_cast<std::uint32_t>(nodes_.size());
  }

  Node summary(std::uint32_t begin, std::uint32_t end) const {
    Node node{centerOf(begin, end), Vector3d::Zero(), Matrix3d::Zero(), 0, begin, end, 0};
    double radius_squared = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Moment m = momentOf(triangles_[i]);
      node.dipole += m.normal;
      node.quadrupole += (m.centroid - node.center) * m.normal.transpose();
      for (const Vector3f& v : triangles_[i]) {
        radius_squared = std::max(radius_squared, (v.cast<double>() - node.center).squaredNorm());
      }
    }
    node.near_squared = accuracy_ * accuracy_ * radius_squared;
    return node;
  }

  // Weighted by area, or plain where there is none.
  Vector3d centerOf(std::uint32_t begin, std::uint32_t end) const {
    Vector3d weighted = Vector3d::Zero(), plain = Vector3d::Zero();
    double area = 0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const Moment m = momentOf(triangles_[i]);
      weighted += m.normal.norm() * m.centroid;
      plain += m.centroid;
      area += m.normal.norm();
    }
    return area > 0 ? Vector3d(weighted / area) : Vector3d(plain / (end - begin));
  }

  std::uint32_t splitInHalves(std::uint32_t begin, std::uint32_t end) {
    Eigen::AlignedBox3f box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(sumOf(triangles_[i]));
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::uint32_t i) { return triangles_.begin() + i; };
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Corners& a, const Corners& b) { return sumOf(a)[axis] < sumOf(b)[axis]; });
    return middle;
  }

  std::vector<Corners>& triangles_;
  double accuracy_;
  std::vector<Node> nodes_;
};

}  // namespace

double solidAngle(const Vector3d& point, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d u = a - point, v = b - point, w = c - point;
  const double lu = u.norm(), lv = v.norm(), lw = w.norm();
  const double numerator = u.dot(v.cross(w));
  const double denominator = lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv;
  return 2 * std::atan2(numerator, denominator);
}

struct WindingNumber::Impl {
  std::vector<Corners> triangles;
  std::vector<Node> nodes;
};

WindingNumber::WindingNumber(const TriangleMesh& mesh, const WindingNumberOptions& options)
    : impl_(std::make_unique<Impl>()) {
  if (!(options.accuracy > 1)) throw InvalidArgument("accuracy", "must be larger than 1");
  for (const Triangle& t : mesh.triangles) {
    const Corners corners{mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    if (sumOf(corners).allFinite()) impl_->triangles.push_back(corners);
  }
  impl_->nodes = TreeBuilder(impl_->triangles, options.accuracy).build();
}

WindingNumber::~WindingNumber() = default;
WindingNumber::WindingNumber(WindingNumber&&) noexcept = default;
WindingNumber& WindingNumber::operator=(WindingNumber&&) noexcept = default;

double WindingNumber::at(const Vector3d& point) const {
  double angle = 0;
  const std::vector<Node>& nodes = impl_->nodes;
  for (std::size_t i = 0; i < nodes.size();) {
    const Node& node = nodes[i];
    const Vector3d offset = node.center - point;
    const double squared = offset.squaredNorm();
    if (squared > node.near_squared) {
      angle += farAngle(node, offset, squared);
    } else if (!node.isLeaf()) {
      ++i;
      continue;
    } else {
      for (std::uint32_t k = node.begin; k < node.end; ++k) {
        const Corners& t = impl_->triangles[k];
        angle += solidAngle(point, t[0].cast<double>(), t[1].cast<double>(), t[2].cast<double>());
      }
    }
    i = node.skip;
  }
  return angle / kFullSphere;
}

}  // namespace vdbfuse
