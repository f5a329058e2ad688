// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pcl/bridge.h"

#include <pcl/conversions.h>

#include <cmath>
#include <string>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {
namespace {

template <class Point>
PointImage pointImage(const pcl::PointCloud<Point>& cloud) {
  PointImage points = noPoints(static_cast<int>(cloud.width), static_cast<int>(cloud.height));
  auto* target = points.data();
  for (const Point& p : cloud) *target++ = p.getVector3fMap();
  return points;
}

void requireOrganised(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  if (cloud.height > 1 && cloud.width > 1 && cloud.size() == std::size_t{cloud.width} * cloud.height) return;
  throw InvalidArgument("cloud", "expected an organised cloud (rows and columns), found " +
                                     std::to_string(cloud.width) + "x" + std::to_string(cloud.height));
}

RigidTransform poseOf(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  const Eigen::Quaterniond turn = cloud.sensor_orientation_.cast<double>();
  constexpr double kTolerance = 1e-3;
  if (!(std::abs(turn.norm() - 1) < kTolerance) || !cloud.sensor_origin_.allFinite())
    throw InvalidArgument("cloud", "expected an orientation of length 1 and a finite origin");
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = turn.normalized().toRotationMatrix();
  pose.translation() = cloud.sensor_origin_.head<3>().cast<double>();
  return pose;
}

// One vertex with all that a mesh may carry, so that one conversion of PCL's serves both ways.
using Vertex = pcl::PointXYZRGBNormal;
using PlainVertex = pcl::PointXYZ;
using NormalVertex = pcl::PointNormal;
using ColorVertex = pcl::PointXYZRGB;

template <class Point>
pcl::PointCloud<Point> vertexCloud(const TriangleMesh& mesh) {
  pcl::PointCloud<Point> cloud;
  cloud.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    cloud[i].getVector3fMap() = mesh.vertices[i];
    if constexpr (pcl::traits::has_normal<Point>::value) cloud[i].getNormalVector3fMap() = mesh.normals[i];
    if constexpr (pcl::traits::has_color<Point>::value) {
      const auto& [r, g, b] = mesh.colors[i];
      cloud[i].r = r, cloud[i].g = g, cloud[i].b = b, cloud[i].a = 255;
    }
  }
  return cloud;
}

template <class Point>
void serialise(const TriangleMesh& mesh, pcl::PCLPointCloud2& target) {
  pcl::toPCLPointCloud2(vertexCloud<Point>(mesh), target);
}

bool hasFields(const pcl::PCLPointCloud2& cloud, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    bool found = false;
    for (const pcl::PCLPointField& field : cloud.fields) found = found || field.name == name;
    if (!found) return false;
  }
  return true;
}

void addFan(const pcl::Vertices& polygon, std::size_t vertices, std::vector<Triangle>& triangles) {
  if (polygon.vertices.size() < 3)
    throw InvalidArgument("mesh", "expected polygons of three corners or more");
  for (const auto index : polygon.vertices) {
    if (index < 0 || static_cast<std::size_t>(index) >= vertices)
      throw InvalidArgument(
          "mesh", "expected an index below " + std::to_string(vertices) + ", found " + std::to_string(index));
  }
  const auto corner = [&](std::size_t i) { return static_cast<std::uint32_t>(polygon.vertices[i]); };
  for (std::size_t i = 2; i < polygon.vertices.size(); ++i)
    triangles.push_back({corner(0), corner(i - 1), corner(i)});
}

}  // namespace

pcl::PointCloud<pcl::PointXYZ> toPointCloud(const View& view) {
  const PointImage points = pointsOf(view);
  pcl::PointCloud<pcl::PointXYZ> cloud(static_cast<std::uint32_t>(points.width()),
                                       static_cast<std::uint32_t>(points.height()));
  auto* target = cloud.data();
  for (const Eigen::Vector3f& point : points) {
    cloud.is_dense = cloud.is_dense && point.allFinite();
    (target++)->getVector3fMap() = point;
  }
  cloud.sensor_origin_ << view.world_from_camera.translation().cast<float>(), 0.0f;
  cloud.sensor_orientation_ = Eigen::Quaterniond(view.world_from_camera.linear()).cast<float>();
  return cloud;
}

View toView(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  requireOrganised(cloud);
  const PointImage points = pointImage(cloud);
  return viewFromPoints(points, fitPinhole(points), poseOf(cloud));
}

View toView(const pcl::PointCloud<pcl::PointXYZ>& cloud, const Projection& projection) {
  requireOrganised(cloud);
  return viewFromPoints(pointImage(cloud), projection, poseOf(cloud));
}

pcl::PolygonMesh toPolygonMesh(const TriangleMesh& mesh) {
  pcl::PolygonMesh result;
  const bool normals = !mesh.normals.empty(), colors = !mesh.colors.empty();
  if (normals && colors) serialise<Vertex>(mesh, result.cloud);
  if (normals && !colors) serialise<NormalVertex>(mesh, result.cloud);
  if (!normals && colors) serialise<ColorVertex>(mesh, result.cloud);
  if (!normals && !colors) serialise<PlainVertex>(mesh, result.cloud);
  result.polygons.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t index : mesh.triangles[i])
      result.polygons[i].vertices.push_back(static_cast<pcl::index_t>(index));
  }
  return result;
}

TriangleMesh toTriangleMesh(const pcl::PolygonMesh& mesh) {
  if (!hasFields(mesh.cloud, {"x", "y", "z"}))
    throw InvalidArgument("mesh", "expected the fields x, y and z");
  pcl::PCLPointCloud2 source = mesh.cloud;
  const bool normals = hasFields(source, {"normal_x", "normal_y", "normal_z"});
  const bool colors = hasFields(source, {"rgb"}) || hasFields(source, {"rgba"});
  TriangleMesh result;
  if (colors) {
    pcl::PointCloud<ColorVertex> vertices;
    pcl::fromPCLPointCloud2(source, vertices);
    for (const ColorVertex& v : vertices) result.colors.push_back({v.r, v.g, v.b});
  }
  if (normals) {
    pcl::PointCloud<NormalVertex> vertices;
    pcl::fromPCLPointCloud2(source, vertices);
    for (const NormalVertex& v : vertices) result.normals.emplace_back(v.getNormalVector3fMap());
  }
  pcl::PointCloud<PlainVertex> vertices;
  pcl::fromPCLPointCloud2(source, vertices);
  for (const PlainVertex& v : vertices) result.vertices.emplace_back(v.getVector3fMap());
  for (const pcl::Vertices& polygon : mesh.polygons) addFan(polygon, vertices.size(), result.triangles);
  return result;
}

}  // namespace vdbfuse
