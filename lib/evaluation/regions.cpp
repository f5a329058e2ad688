// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/evaluation/regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

nlohmann::json parseFile(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) throw IoError(path, "", "a file with regions", "none");
  try {
    return json::parse(file);
  } catch (const json::parse_error& error) {
    throw IoError(path, "byte " + std::to_string(error.byte), "JSON", "something else");
  }
}

// Reads the members of one region; every failure names it.
class RegionReader {
 public:
  RegionReader(const std::filesystem::path& path, const json& region, std::size_t index)
      : path_(path), region_(region), label_("region " + std::to_string(index)) {}

  Region read() {
    if (!region_.is_object()) fail("an object");
    Region region{text("name"), expectation(), {}};
    region.shape = shape();
    return region;
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    throw IoError(path_, "", expected + " in " + label_, region_.dump().substr(0, 100));
  }

  std::string text(const char* key) const {
    const auto found = region_.find(key);
    if (found == region_.end() || !found->is_string()) fail(std::string("the text '") + key + "'");
    return *found;
  }

  Expectation expectation() const {
    const std::string word = text("expect");
    if (word == "outside") return Expectation::Outside;
    if (word == "inside") return Expectation::Inside;
    fail("'expect' to be outside or inside");
  }

  double positive(const char* key) const {
    const auto found = region_.find(key);
    if (found == region_.end() || !found->is_number() || !(found->get<double>() > 0)) {
      fail(std::string("the positive number '") + key + "'");
    }
    return *found;
  }

  Vector3d vectorOf(const json& value, const char* key) const {
    const auto is_number = [](const json& x) { return x.is_number(); };
    if (!value.is_array() || value.size() != 3 || !std::all_of(value.begin(), value.end(), is_number)) {
      fail(std::string("three numbers '") + key + "'");
    }
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }

  Vector3d vector(const char* key) const { return vectorOf(region_.value(key, json()), key); }

  RegionShape shape() const {
    const std::string kind = text("shape");
    if (kind == "box") return box();
    if (kind == "sphere") return RegionSphere{vector("center"), positive("radius")};
    if (kind == "cylinder") return cylinder();
    if (kind == "oriented_box") return orientedBox();
    fail("'shape' to be box, sphere, cylinder or oriented_box");
  }

  Box box() const {
    const Vector3d low = vector("min"), high = vector("max");
    if (!(low.array() < high.array()).all()) fail("'min' below 'max'");
    return {low, high};
  }

  RegionCylinder cylinder() const {
    const RegionCylinder cylinder{vector("from"), vector("to"), positive("radius")};
    if (cylinder.from == cylinder.to) fail("'from' to differ from 'to'");
    return cylinder;
  }

  RegionOrientedBox orientedBox() const {
    RegionOrientedBox box{vector("center"), {}, vector("half_extents")};
    const json rows = region_.value("axes", json());
    if (!rows.is_array() || rows.size() != 3) fail("three vectors 'axes'");
    for (int k = 0; k < 3; ++k)
      box.axes.col(k) = vectorOf(rows[static_cast<std::size_t>(k)], "axes").normalized();
    if (!(box.half_extents.array() > 0).all()) fail("positive 'half_extents'");
    const Eigen::Matrix3d deviation = box.axes.transpose() * box.axes - Eigen::Matrix3d::Identity();
    if (!(deviation.cwiseAbs().maxCoeff() < 1e-3)) fail("orthogonal 'axes'");
    return box;
  }

  const std::filesystem::path& path_;
  const json& region_;
  std::string label_;
};

Vector3d pointInCube(Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

Vector3d pointIn(const Box& box, Random& random) {
  return box.center() + 0.5 * box.sizes().cwiseProduct(pointInCube(random));
}

Vector3d pointIn(const RegionSphere& sphere, Random& random) {
  for (;;) {
    const Vector3d p = pointInCube(random);
    if (p.squaredNorm() <= 1) return sphere.center + sphere.radius * p;
  }
}

Vector3d pointIn(const RegionCylinder& cylinder, Random& random) {
  const Vector3d along = cylinder.to - cylinder.from;
  const Vector3d u = along.unitOrthogonal(), v = along.normalized().cross(u);
  const double r = cylinder.radius * std::sqrt(random.uniform()),
               angle = random.uniform(0, 2 * std::numbers::pi);
  return cylinder.from + random.uniform() * along + r * (std::cos(angle) * u + std::sin(angle) * v);
}

Vector3d pointIn(const RegionOrientedBox& box, Random& random) {
  return box.center + box.axes * box.half_extents.cwiseProduct(pointInCube(random));
}

}  // namespace

std::vector<Region> readRegions(const std::filesystem::path& path) {
  const json file = parseFile(path);
  const auto list = file.is_object() ? file.find("regions") : file.end();
  if (list == file.end() || !list->is_array())
    throw IoError(path, "", "an object with an array 'regions'", "none");
  std::vector<Region> regions;
  for (const json& region : *list) regions.push_back(RegionReader(path, region, regions.size()).read());
  return regions;
}

std::vector<Vector3d> sampleRegion(const RegionShape& shape, std::size_t count, std::uint64_t seed) {
  std::vector<Vector3d> points(count);
  Random random(seed);
  std::visit(
      [&](const auto& s) {
        for (Vector3d& p : points) p = pointIn(s, random);
      },
      shape);
  return points;
}

}  // namespace vdbfuse
