// SPDX-License-Identifier: Apache-2.0
// Projection of many world points into one view, and back: the transform prepared once, the common pinhole
// inlined.
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "vdbfuse/geometry/distortion.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// The pixel that sees a world point.
struct Sighting {
  int x = 0, y = 0;  ///< nearest pixel, inside the image
  double depth = 0;  ///< of the point, in the sensor's own measure
};

/// An undistorted pinhole as a 3×4 matrix in single precision for points relative to some origin: rows
/// (u·depth, v·depth, depth).
struct PinholeRows {
  std::array<std::array<float, 4>, 3> rows{};
  int width = 0, height = 0;
};

class Projector {
 public:
  Projector(const Projection& projection, const RigidTransform& world_from_camera)
      : projection_(projection),
        rotation_(world_from_camera.linear().transpose()),
        translation_(-(rotation_ * world_from_camera.translation())),
        width_(imageWidth(projection)),
        height_(imageHeight(projection)) {
    const Pinhole* pinhole = std::get_if<Pinhole>(&projection);
    if (pinhole == nullptr || isDistorted(*pinhole)) return;
    pinhole_ = *pinhole;
    const Pinhole& c = *pinhole;
    sides_ = {Eigen::Vector3d(c.fx, 0, c.cx + 0.5), Eigen::Vector3d(-c.fx, 0, width_ - 0.5 - c.cx),
              Eigen::Vector3d(0, c.fy, c.cy + 0.5), Eigen::Vector3d(0, -c.fy, height_ - 0.5 - c.cy)};
    for (Eigen::Vector3d& side : sides_) side.normalize();
  }

  int width() const { return width_; }

  /// False only when no point of a ball can be seen. An undistorted pinhole tests its frustum, others say
  /// true.
  bool mightSee(const Eigen::Vector3d& centre, double radius) const {
    if (!pinhole_) return true;
    const Eigen::Vector3d p = rotation_ * centre + translation_;
    if (p.z() < -radius) return false;
    for (const Eigen::Vector3d& side : sides_)
      if (side.dot(p) < -radius) return false;
    return true;
  }

  /// Nothing when the point lies behind the sensor or outside its image.
  std::optional<Sighting> operator()(const Eigen::Vector3d& world) const {
    const Eigen::Vector3d p = rotation_ * world + translation_;
    if (!pinhole_) return general(p);
    if (!(p.z() > 0)) return std::nullopt;
    const double inverse = 1.0 / p.z();
    return inside(pinhole_->fx * p.x() * inverse + pinhole_->cx,
                  pinhole_->fy * p.y() * inverse + pinhole_->cy, p.z());
  }

  /// Where between the pixels, inside the image.
  std::optional<PixelDepth> place(const Eigen::Vector3d& world) const {
    const Eigen::Vector3d p = rotation_ * world + translation_;
    std::optional<PixelDepth> seen;
    if (!pinhole_) {
      seen = project(projection_, p);
    } else if (p.z() > 0) {
      seen = PixelDepth{pinhole_->fx * p.x() / p.z() + pinhole_->cx,
                        pinhole_->fy * p.y() / p.z() + pinhole_->cy, p.z()};
    }
    if (!seen || !inside(seen->x, seen->y, seen->depth)) return std::nullopt;
    return seen;
  }

  /// For loops over many points near `origin`; nothing for other projections.
  std::optional<PinholeRows> rowsFrom(const Eigen::Vector3d& origin) const {
    if (!pinhole_) return std::nullopt;
    Eigen::Matrix3d camera = Eigen::Matrix3d::Identity();
    camera(0, 0) = pinhole_->fx, camera(0, 2) = pinhole_->cx;
    camera(1, 1) = pinhole_->fy, camera(1, 2) = pinhole_->cy;
    const Eigen::Matrix3d linear = camera * rotation_;
    const Eigen::Vector3d constant = camera * (rotation_ * origin + translation_);
    PinholeRows result{{}, width_, height_};
    for (int r = 0; r < 3; ++r) {
      std::array<float, 4>& row = result.rows[static_cast<std::size_t>(r)];
      for (int c = 0; c < 3; ++c) row[static_cast<std::size_t>(c)] = static_cast<float>(linear(r, c));
      row[3] = static_cast<float>(constant[r]);
    }
    return result;
  }

 private:
  std::optional<Sighting> general(const Eigen::Vector3d& p) const {
    const std::optional<PixelDepth> seen = project(projection_, p);
    if (!seen) return std::nullopt;
    return inside(seen->x, seen->y, seen->depth);
  }
  std::optional<Sighting> inside(double x, double y, double depth) const {
    if (!(x >= -0.5 && y >= -0.5 && x < width_ - 0.5 && y < height_ - 0.5)) return std::nullopt;
    return Sighting{static_cast<int>(x + 0.5), static_cast<int>(y + 0.5), depth};
  }

  Projection projection_;
  std::optional<Pinhole> pinhole_;
  std::array<Eigen::Vector3d, 4> sides_;  ///< of the frustum, unit normals inwards, camera coordinates
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
  int width_, height_;
};

/// World points of many pixels of one view.
class Unprojector {
 public:
  Unprojector(const Projection& projection, const RigidTransform& world_from_camera)
      : projection_(projection), world_from_camera_(world_from_camera) {
    const Pinhole* pinhole = std::get_if<Pinhole>(&projection);
    if (pinhole == nullptr || isDistorted(*pinhole)) return;
    const auto& rotation = world_from_camera.linear();
    per_x_ = rotation.col(0) / pinhole->fx, per_y_ = rotation.col(1) / pinhole->fy;
    corner_ = rotation.col(2) - pinhole->cx * per_x_ - pinhole->cy * per_y_;
    is_pinhole_ = true;
  }

  Eigen::Vector3d operator()(double x, double y, double depth) const {
    if (!is_pinhole_) return world_from_camera_ * unproject(projection_, x, y, depth);
    return world_from_camera_.translation() + depth * (corner_ + x * per_x_ + y * per_y_);
  }

 private:
  Projection projection_;
  RigidTransform world_from_camera_;
  bool is_pinhole_ = false;
  /// The ray of pixel (0, 0) at depth 1, and its change a pixel.
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero(), per_x_ = corner_, per_y_ = corner_;
};

}  // namespace vdbfuse
