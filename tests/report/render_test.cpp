// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/report/color_map.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

constexpr Rgb8 kWhite{255, 255, 255};

ViewHeader frontView(int width = 81, int height = 61) {
  return cameraLookingAt({0, -4, 0}, Vector3d::Zero(), Vector3d::UnitZ(), width, height);
}

int brightness(const Rgb8& c) { return c[0] + c[1] + c[2]; }

// The face of a box that looks at frontView().
TriangleMesh wall() { return test::box({-5, 0, -5}, {5, 1, 5}); }

TEST(Render, ASphereCoversWhatItsProjectionCovers) {
  const ViewHeader view = frontView(161, 121);
  RenderOptions options;
  options.background = {1, 2, 3};
  const Image<Rgb8> picture = render(test::sphere(0.8, 5), view, options);
  const double sine = 0.8 / 4;
  const auto& camera = std::get<Pinhole>(view.projection);
  const double radius = camera.fx * sine / std::sqrt(1 - sine * sine);
  for (int y = 0; y < 121; ++y)
    for (int x = 0; x < 161; ++x) {
      const double r = std::hypot(x - camera.cx, y - camera.cy);
      if (std::abs(r - radius) < 1.5) continue;
      EXPECT_EQ(picture(x, y) == options.background, r > radius) << x << " " << y;
    }
}

TEST(Render, WhatFacesTheSensorIsBrightestAndTheSkyLightsTheTop) {
  const Image<Rgb8> picture = render(test::sphere(0.8, 5), frontView());
  EXPECT_GT(brightness(picture(40, 30)), brightness(picture(40 + 18, 30)));
  EXPECT_GT(brightness(picture(40, 30 - 15)), brightness(picture(40, 30 + 15)));
}

TEST(Render, AWorldThatIsUpsideDownIsDrawnSo) {
  TriangleMesh mesh = test::sphere(0.5, 3, {0, 0, 0.6});
  const Image<Rgb8> picture = render(mesh, frontView());
  EXPECT_NE(picture(40, 30 - 13), kWhite);
  EXPECT_EQ(picture(40, 30 + 13), kWhite);
}

TEST(Render, AWallThatFacesTheSensorHasTheNormalTowardsIt) {
  RenderOptions options;
  options.coloring = MeshColoring::Normal, options.normals = RenderOptions::Normals::Flat;
  const Rgb8 expected{128, 128, 255};
  EXPECT_EQ(render(wall(), frontView(), options)(40, 30), expected);
}

TEST(Render, InventedSurfaceIsOrangeAndSupportedSurfaceIsNot) {
  TriangleMesh mesh = wall();
  RenderOptions options;
  options.coloring = MeshColoring::Support;
  mesh.support.assign(mesh.vertices.size(), 0.0f);
  const Rgb8 invented = render(mesh, frontView(), options)(40, 30);
  EXPECT_GT(invented[0], invented[1] + 60);
  EXPECT_GT(invented[1], invented[2] + 60);
  mesh.support.assign(mesh.vertices.size(), 8.0f);
  const Rgb8 supported = render(mesh, frontView(), options)(40, 30);
  EXPECT_GT(supported[1], supported[2] + 60);
  EXPECT_LT(std::abs(supported[0] - supported[1]), 40);
}

TEST(Render, TheMeshsOwnColoursAreDrawn) {
  TriangleMesh mesh = wall();
  RenderOptions options;
  options.coloring = MeshColoring::Vertex;
  EXPECT_FALSE(validate(options, mesh).empty());
  mesh.colors.assign(mesh.vertices.size(), Rgb8{0, 200, 0});
  const Rgb8 drawn = render(mesh, frontView(), options)(40, 30);
  EXPECT_GT(drawn[1], 100);
  EXPECT_EQ(drawn[0], 0);
  EXPECT_EQ(drawn[2], 0);
}

TEST(RenderTurntable, ShowsTheMeshFromAllSidesInRows) {
  // A box with one red side: some pictures show it, others do not.
  TriangleMesh mesh = test::box({-1, -1, -1}, {1, 1, 1});
  for (const Eigen::Vector3f& v : mesh.vertices)
    mesh.colors.push_back(v.y() < 0 ? Rgb8{255, 0, 0} : Rgb8{0, 0, 255});
  RenderOptions options;
  options.coloring = MeshColoring::Vertex;
  const Image<Rgb8> sheet = renderTurntable(mesh, 5, 40, 30, options);
  ASSERT_EQ(sheet.width(), 3 * 40);
  ASSERT_EQ(sheet.height(), 2 * 30);
  std::vector<int> red(6, 0);
  for (int y = 0; y < sheet.height(); ++y)
    for (int x = 0; x < sheet.width(); ++x)
      red[static_cast<std::size_t>(y / 30 * 3 + x / 40)] += sheet(x, y)[0] > 2 * sheet(x, y)[2] + 20 ? 1 : 0;
  EXPECT_GT(red[0], 50);
  EXPECT_LT(std::min(red[2], red[3]), red[0] / 2);
  EXPECT_EQ(red[5], 0) << "nothing there";
  EXPECT_EQ(sheet(100, 45), options.background);
}

TEST(Render, ValuesRunOverTheGivenRange) {
  const TriangleMesh mesh = wall();
  RenderOptions options;
  options.coloring = MeshColoring::Values, options.low = 0, options.high = 1;
  const auto colorAt = [&](float value) {
    options.values.assign(mesh.vertices.size(), value);
    return render(mesh, frontView(), options)(40, 30);
  };
  EXPECT_EQ(colorAt(2), colorAt(1));
  EXPECT_GT(brightness(colorAt(1)), brightness(colorAt(0.5)));
  EXPECT_GT(brightness(colorAt(0.5)), brightness(colorAt(0)));
}

TEST(Render, TheInnerSideOfASurfaceIsViolet) {
  TriangleMesh mesh = wall();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const Rgb8 inner = render(mesh, frontView())(40, 30);
  EXPECT_GT(inner[2], inner[0] + 30);
  EXPECT_GT(inner[0], inner[1] + 30);
}

TEST(Render, SupersamplingSmoothsTheOutline) {
  const auto colors = [](int supersampling) {
    RenderOptions options;
    options.supersampling = supersampling, options.coloring = MeshColoring::Values, options.high = 1;
    const TriangleMesh mesh = test::box({-1, -1, -1}, {1, 1, 1});
    options.values.assign(mesh.vertices.size(), 1.0f), options.normals = RenderOptions::Normals::Flat;
    const Image<Rgb8> picture = render(mesh, frontView(83, 61), options);
    return std::count_if(picture.begin(), picture.end(),
                         [](const Rgb8& c) { return c[2] > 130 && c[2] < 250; });
  };
  EXPECT_EQ(colors(1), 0);
  EXPECT_GT(colors(4), 50);
}

TEST(Render, IsTheSameForOneThreadAndTwo) {
  const auto picture = [](int threads) {
    const ThreadLimit limit(threads);
    return render(test::sphere(0.8, 4), frontView());
  };
  EXPECT_EQ(picture(1), picture(2));
}

TEST(Render, EveryProjectionDrawsTheMesh) {
  const RigidTransform pose = lookAt({0, -4, 0}, Vector3d::Zero(), Vector3d::UnitZ());
  const Spherical spherical{81, 61, -0.4, 0.01, -0.3, 0.01};
  const Orthographic orthographic{81, 61, -1.2, 0.03, -0.9, 0.03};
  const PushBroom push_broom{81, 61, -1.2, 0.03, 0, 120, 30};
  for (const Projection& projection :
       {Projection(spherical), Projection(orthographic), Projection(push_broom)}) {
    const Image<Rgb8> picture = render(test::sphere(0.5, 4), {"", projection, pose});
    EXPECT_NE(picture(40, 30), kWhite);
    EXPECT_EQ(picture(0, 0), kWhite);
  }
}

TEST(Render, EverythingThatIsWrongWithTheOptionsIsListed) {
  RenderOptions options;
  options.supersampling = 0, options.up.setZero(), options.coloring = MeshColoring::Support;
  EXPECT_EQ(validate(options, wall()).size(), 3u);
  EXPECT_THROW(render(wall(), frontView(), options), InvalidArgument);
  options = {};
  options.coloring = MeshColoring::Values;
  EXPECT_EQ(validate(options, wall()), std::vector<std::string>{"there must be one value a vertex"});
}

TEST(FramingCamera, ShowsAllOfTheMeshAndNotMuchElse) {
  for (const Vector3d& up : {Vector3d(0, 0, 1), Vector3d(0, 1, 0), Vector3d(-1, 0, 0)}) {
    for (const auto& [width, height] : {std::pair{80, 60}, std::pair{60, 80}}) {
      const TriangleMesh mesh = test::box({10, 20, 30}, {14, 21, 32});
      const ViewHeader view = framingCamera(mesh, up, width, height);
      double nearest_border = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector3f& vertex : mesh.vertices) {
        const auto p = project(view.projection, view.world_from_camera.inverse() * vertex.cast<double>());
        ASSERT_TRUE(p);
        nearest_border = std::min({nearest_border, p->x, p->y, width - 1 - p->x, height - 1 - p->y});
      }
      EXPECT_GE(nearest_border, 0);
      EXPECT_LT(nearest_border, 5);
      EXPECT_LT(view.world_from_camera.linear().col(1).dot(up), 0);  // y is down
    }
  }
}

}  // namespace
}  // namespace vdbfuse
