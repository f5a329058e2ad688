// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/geometry/look_at.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 1.0;

// The colour painted on the sphere at a point.
Rgb8 paint(const Vector3d& p) {
  const auto level = [](double x) { return static_cast<std::uint8_t>(std::lround(128 + 100 * x)); };
  return {level(p.x()), level(p.y()), level(std::sin(3 * p.z()))};
}

// Depth along a ray to the sphere; 0 beside it.
double depthOf(const Vector3d& eye, const Vector3d& ray) {
  const double a = ray.squaredNorm(), b = eye.dot(ray), c = eye.squaredNorm() - kRadius * kRadius;
  const double root = b * b - a * c;
  return root > 0 ? (-b - std::sqrt(root)) / a : 0;
}

Pinhole camera(int width) {
  return {.width = width,
          .height = width,
          .fx = 1.2 * width,
          .fy = 1.2 * width,
          .cx = 0.5 * (width - 1),
          .cy = 0.5 * (width - 1)};
}

Image<Rgb8> picture(const Projection& projection, const RigidTransform& pose) {
  Image<Rgb8> image(imageWidth(projection), imageHeight(projection), Rgb8{0, 0, 0});
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Vector3d ray = pose.linear() * unproject(projection, x, y, 1.0);
      const double depth = depthOf(pose.translation(), ray);
      if (depth > 0) image(x, y) = paint(pose.translation() + depth * ray);
    }
  return image;
}

// Looks at the sphere from a direction; pictures of another size than the depths.
View lookFrom(const Vector3d& direction, int picture_width = 300) {
  View view;
  view.projection = camera(150);
  view.world_from_camera =
      lookAt(3 * direction.normalized(), Vector3d::Zero(), Vector3d(0.1, 0.2, 0.97).normalized());
  view.map.depth = Image<float>(150, 150, kInvalidDepth);
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 150; ++x) {
      const Vector3d ray = view.world_from_camera.linear() * unproject(view.projection, x, y, 1.0);
      view.map.depth(x, y) = static_cast<float>(depthOf(view.world_from_camera.translation(), ray));
    }
  view.map.color = picture(camera(picture_width), view.world_from_camera);
  return view;
}

std::vector<View> allAround() {
  std::vector<View> views;
  for (int k = 0; k < 6; ++k) views.push_back(lookFrom((k % 2 == 0 ? 1 : -1) * Vector3d::Unit(k / 2)));
  for (int k = 0; k < 8; ++k)
    views.push_back(lookFrom(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  return views;
}

TriangleMesh ball() {
  TriangleMesh mesh = test::sphere(kRadius, 5);
  mesh.normals = vertexNormals(mesh);
  return mesh;
}

double meanError(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Rgb8 truth = paint(mesh.vertices[v].cast<double>());
    for (std::size_t c = 0; c < 3; ++c) sum += std::abs(mesh.colors[v][c] - truth[c]);
  }
  return sum / (3.0 * static_cast<double>(mesh.vertices.size()));
}

TEST(ColorVertices, GivesEveryVertexItsPaintFromPicturesOfAnotherSize) {
  TriangleMesh mesh = ball();
  const ColorReport report = colorVertices(ViewSequence::fromViews(allAround()), {0.02}, mesh);
  EXPECT_EQ(report.views, 14u);
  EXPECT_GT(report.colored, mesh.vertices.size() * 99 / 100);
  EXPECT_LT(meanError(mesh), 2);
}

TEST(ColorVertices, PicturesOfASensorOfTheirOwnAreLookedUpThere) {
  std::vector<View> views = allAround();
  for (View& view : views) {
    RigidTransform beside = view.world_from_camera;
    beside.translation() += beside.linear() * Vector3d(0.15, 0, 0);
    view.color_sensor = ColorSensor{camera(220), beside};
    view.map.color = picture(camera(220), beside);
  }
  TriangleMesh mesh = ball();
  colorVertices(ViewSequence::fromViews(std::move(views)), {0.02}, mesh);
  EXPECT_LT(meanError(mesh), 2);
}

TEST(ColorVertices, AThirdOfThePicturesBeingWrongHardlyMatters) {
  std::vector<View> views = allAround();
  for (std::size_t i = 0; i < views.size(); i += 5)
    std::fill(views[i].map.color.begin(), views[i].map.color.end(), Rgb8{255, 0, 255});
  TriangleMesh mesh = ball();
  colorVertices(ViewSequence::fromViews(std::move(views)), {0.02}, mesh);
  EXPECT_LT(meanError(mesh), 8);
}

TEST(ColorVertices, WhatNoPictureShowsTakesTheColourBesideIt) {
  View front = lookFrom(Vector3d(0, 0, 1));
  std::fill(front.map.color.begin(), front.map.color.end(), Rgb8{10, 200, 30});
  TriangleMesh mesh = test::joined(ball(), test::sphere(0.3, 2, {5, 0, 0}));
  mesh.normals = vertexNormals(mesh);
  const ColorReport report = colorVertices(ViewSequence::fromViews({front}), {0.02}, mesh);
  EXPECT_LT(report.colored, mesh.vertices.size() / 2);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    ASSERT_EQ(mesh.colors[v], mesh.vertices[v].x() > 3 ? (Rgb8{128, 128, 128}) : (Rgb8{10, 200, 30}));
}

TEST(ColorVertices, WithoutPicturesNothingHappens) {
  View view = lookFrom(Vector3d(0, 0, 1));
  view.map.color = {};
  TriangleMesh mesh = ball();
  EXPECT_EQ(colorVertices(ViewSequence::fromViews({view}), {0.02}, mesh).views, 0u);
  EXPECT_TRUE(mesh.colors.empty());
  EXPECT_THROW(colorVertices(ViewSequence::fromViews({view}), {}, mesh), InvalidArgument);
}

TEST(ColorVertices, IsTheSameForEveryNumberOfThreads) {
  std::vector<TriangleMesh> meshes;
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    meshes.push_back(ball());
    colorVertices(ViewSequence::fromViews(allAround()), {0.02}, meshes.back());
  }
  EXPECT_EQ(meshes[0].colors, meshes[1].colors);
}

}  // namespace
}  // namespace vdbfuse
