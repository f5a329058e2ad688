// SPDX-License-Identifier: Apache-2.0
// What matters of a set of photographs is what stereo makes of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/formats/image_set.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse {
namespace {

using test::TemporaryFolder;

const Box kBox(Eigen::Vector3d(-0.8, -0.6, -0.2), Eigen::Vector3d(0.8, 0.6, 0.4));

// Of points of the plane z = (x + y)/10.
double texture(double x, double y) {
  double sum = 0;
  for (int k = 1; k <= 12; ++k) {
    const double angle = 2.4 * k, number = 12 + 4.5 * k;
    sum += std::sin(number * (std::cos(angle) * x + std::sin(angle) * y) + 1.7 * k * k);
  }
  return 0.5 + 0.07 * sum;
}

Photograph photograph(int number) {
  const double angle = (number - 2) * 9 * std::numbers::pi / 180;
  Photograph result;
  result.name = std::to_string(number);
  // What every format holds: one focal length, the principal point in the middle.
  result.camera = {96, 72, 125, 125, 47.5, 35.5, {}};
  result.world_from_camera =
      lookAt({2 * std::sin(angle), 0.2 * number - 0.5, -2 * std::cos(angle)}, {0, 0, 0}, {0, -1, 0});
  result.brightness = Image<float>(96, 72);
  const Eigen::Vector3d normal(0.1, 0.1, -1), eye = result.world_from_camera.translation();
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 96; ++x) {
      const Eigen::Vector3d ray = result.world_from_camera.linear() * unproject(result.camera, x, y, 1);
      const Eigen::Vector3d point = eye - normal.dot(eye) / normal.dot(ray) * ray;
      // As written to disk: of 16 bits.
      const double brightness = std::clamp(texture(point.x(), point.y()), 0.0, 1.0);
      result.brightness(x, y) = static_cast<float>(std::round(65535 * brightness) / 65535);
    }
  return result;
}

PhotographSequence photographs() {
  std::vector<Photograph> all;
  for (int i = 0; i < 5; ++i) all.push_back(photograph(i));
  return PhotographSequence::fromPhotographs(std::move(all));
}

StereoResult match(const PhotographSequence& set) {
  StereoOptions options;
  options.domain = kBox;
  return computeDepthMaps(set, options);
}

// Of the pixels that have a depth in one or the other, those whose depths differ by more than a thousandth.
double shareOff(const Image<float>& found, const Image<float>& expected) {
  double off = 0, all = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const float a = found.data()[i], b = expected.data()[i];
    if (a == kInvalidDepth && b == kInvalidDepth) continue;
    ++all;
    off += a == kInvalidDepth || b == kInvalidDepth || std::abs(a - b) > 1e-3F * b ? 1 : 0;
  }
  EXPECT_GT(all, 4000);
  return off / all;
}

TEST(ImageSets, TheSamePhotographsInEveryFormatGiveTheSameDepthMaps) {
  const PhotographSequence truth = photographs();
  const StereoResult expected = match(truth);
  for (const ImageSetFormat& format : imageSetFormats()) {
    SCOPED_TRACE(format.name);
    const TemporaryFolder folder;
    writeImageSet(folder / "set", std::string(format.name), truth);
    const StereoResult found = match(readImageSet(folder / "set").photographs);
    ASSERT_EQ(found.views.size(), expected.views.size());
    for (std::size_t i = 0; i < found.views.size(); ++i) {
      EXPECT_EQ(found.views[i].partners, expected.views[i].partners);
      EXPECT_LE(shareOff(found.views[i].view.map.depth, expected.views[i].view.map.depth), 0.005) << i;
    }
  }
}

}  // namespace
}  // namespace vdbfuse
