// SPDX-License-Identifier: Apache-2.0
#include "formats/tiny_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "vdbfuse/geometry/projection.h"

namespace vdbfuse::test {
namespace {

// Where the ray from `origin` to `far` meets the surface, as a share of the way; 1 when it does not.
double meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& far) {
  const auto above = [&](double t) {
    const Eigen::Vector3d p = origin + t * (far - origin);
    return p.z() - tinyHeight(p.x(), p.y());
  };
  constexpr int kSteps = 400;
  double low = 0;
  for (int i = 1; i <= kSteps; ++i) {
    double high = static_cast<double>(i) / kSteps;
    if (above(high) > 0) {
      low = high;
      continue;
    }
    for (int k = 0; k < 40; ++k) (above(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  }
  return 1;
}

void render(View& view, double reach) {
  const int width = imageWidth(view.projection), height = imageHeight(view.projection);
  view.map.depth = Image<float>(width, height, kInvalidDepth);
  view.map.color = Image<Rgb8>(width, height);
  const Eigen::Vector3d origin = view.world_from_camera.translation();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto shade = [](int v) { return static_cast<std::uint8_t>(v); };
      view.map.color(x, y) = {shade(5 + 9 * x), shade(3 + 11 * y), shade(40 + 3 * x + 2 * y)};
      const double t = meet(origin, view.world_from_camera * unproject(view.projection, x, y, reach));
      if (t < 1) view.map.depth(x, y) = static_cast<float>(t * reach);
    }
  }
  view.map.depth(0, 0) = kInvalidDepth;
}

}  // namespace

double tinyHeight(double x, double y) {
  const auto bump = [&](double cx, double cy, double height, double radius) {
    return height * std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (radius * radius));
  };
  return bump(0.2, 0.1, 0.5, 0.4) + bump(-0.5, -0.2, 0.3, 0.3);
}

std::vector<View> tinyViews(std::size_t count) {
  std::vector<View> views(count);
  for (std::size_t i = 0; i < count; ++i) {
    View& view = views[i];
    view.name = std::to_string(i);
    view.projection = Pinhole{24, 18, 22.5, 23.25, 11.75, 8.5, {}};
    const auto k = static_cast<double>(i);
    const Eigen::Matrix3d down =
        Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const Eigen::AngleAxisd tilt(0.25 + 0.08 * k, Eigen::Vector3d(0.5, 1.0 - 0.6 * k, 0.2).normalized());
    const Eigen::AngleAxisd roll(0.3 + 0.5 * k, Eigen::Vector3d::UnitZ());
    view.world_from_camera.linear() = (tilt * roll).toRotationMatrix() * down;
    // Looks at the middle of the scene from 2 m away.
    view.world_from_camera.translation() = -2.0 * view.world_from_camera.linear().col(2);
    render(view, 6.0);
  }
  return views;
}

std::vector<View> tinySphericalViews(std::size_t count) {
  std::vector<View> views(count);
  for (std::size_t i = 0; i < count; ++i) {
    View& view = views[i];
    view.name = std::to_string(i);
    const auto k = static_cast<double>(i);
    const double full = 2 * std::numbers::pi, degree = full / 360;
    view.projection = Spherical{40, 16, -0.5 * full + full / 80, full / 40, 5 * degree, 3 * degree};
    // A level scanner: x right, y down, z forward from a world with z up.
    Eigen::Matrix3d level;
    level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    view.world_from_camera.linear() =
        Eigen::AngleAxisd(0.4 + 0.7 * k, Eigen::Vector3d::UnitZ()).toRotationMatrix() * level;
    view.world_from_camera.translation() = Eigen::Vector3d(0.9 - 1.7 * k, -0.5 + 0.8 * k, 1.0);
    render(view, 20.0);
  }
  return views;
}

std::vector<View> tinyDenseScans(std::size_t count) {
  std::vector<View> views = tinySphericalViews(count);
  for (View& view : views) {
    const double degree = std::numbers::pi / 180, step = 0.4 * degree;
    const Eigen::Vector3d middle = view.world_from_camera.inverse() * Eigen::Vector3d::Zero();
    const double azimuth = std::atan2(middle.x(), middle.z());
    view.projection = Spherical{60, 40, azimuth - 29.5 * step, step, 28 * degree, step};
    render(view, 20.0);
  }
  return views;
}

void expectSameViews(const ViewSequence& found, const std::vector<View>& truth, double tolerance) {
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const View view = found.load(i);
    EXPECT_TRUE(view.world_from_camera.isApprox(truth[i].world_from_camera, 1e-6))
        << "view " << i << "\n"
        << view.world_from_camera.matrix();
    const auto *camera = std::get_if<Pinhole>(&view.projection),
               *expected = std::get_if<Pinhole>(&truth[i].projection);
    ASSERT_EQ(camera == nullptr, expected == nullptr);
    if (camera != nullptr) {
      EXPECT_NEAR(camera->fx, expected->fx, 1e-3);
      EXPECT_NEAR(camera->fy, expected->fy, 1e-3);
      EXPECT_NEAR(camera->cx, expected->cx, 1e-3);
      EXPECT_NEAR(camera->cy, expected->cy, 1e-3);
    }
    ASSERT_TRUE(view.map.depth.sameSize(truth[i].map.depth));
    for (int y = 0; y < view.map.depth.height(); ++y) {
      for (int x = 0; x < view.map.depth.width(); ++x)
        ASSERT_NEAR(view.map.depth(x, y), truth[i].map.depth(x, y), tolerance)
            << "view " << i << ", pixel " << x << ", " << y;
    }
  }
}

void expectOnSurface(const ViewSequence& found, double tolerance, double least_valid) {
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    const View view = found.load(i);
    double valid = 0, on_surface = 0;
    for (int y = 0; y < view.map.depth.height(); ++y) {
      for (int x = 0; x < view.map.depth.width(); ++x) {
        if (view.map.depth(x, y) == kInvalidDepth) continue;
        const Eigen::Vector3d p = worldPoint(view, x, y);
        valid += 1;
        on_surface += std::abs(p.z() - tinyHeight(p.x(), p.y())) <= tolerance ? 1 : 0;
      }
    }
    EXPECT_GE(valid, least_valid * static_cast<double>(view.map.depth.size())) << "view " << i;
    EXPECT_GE(on_surface, 0.95 * valid) << "view " << i;
  }
}

}  // namespace vdbfuse::test
