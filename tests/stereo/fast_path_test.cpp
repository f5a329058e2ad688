// SPDX-License-Identifier: Apache-2.0
// How near the fast path comes to the truth and to mode `paper`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "stereo/matching_constants.h"
#include "stereo/paper_ray.h"
#include "stereo/textured_planes.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse {
namespace {

using test::TexturedScene;

constexpr int kCameras = 5;
constexpr double kStepDeg = 10;
constexpr int kMargin = 3;  // pixels from the border of the picture, and from depth edges
const DepthInterval kDepths{1.5, 2.7};
const double kHalf = std::sqrt(0.5);

const TexturedScene kFrontal(test::Rectangles{{.origin = {0, 0, 0.1}, .half_u = 3, .half_v = 3}});
// 45° about both axes, as seen from the middle camera.
const TexturedScene kSlanted(test::Rectangles{
    {.origin = {-0.5, 0, 0}, .u = {kHalf, 0, kHalf}, .half_u = 0.7, .half_v = 3},
    {.origin = {0.55, 0, 0}, .v = {0, kHalf, -kHalf}, .half_u = 0.5, .half_v = 0.7, .seed = 2}});
const TexturedScene kBall({{.origin = {0, 0, 0.5}, .half_u = 3, .half_v = 3, .seed = 3}},
                          {{.middle = {0, 0, 0.1}, .radius = 0.45, .seed = 4}});
// A strip in front of a wall: beside it half of the partners see the strip and not the wall.
const TexturedScene kOccluded(test::Rectangles{
    {.origin = {0, 0, 0.5}, .half_u = 3, .half_v = 3},
    {.origin = {0, 0, -0.3}, .half_u = 0.12, .half_v = 3, .seed = 2}});

struct Set {
  std::vector<Photograph> photographs;
  std::vector<Image<float>> truths;
};

Set setOf(const TexturedScene& scene, const std::vector<PhotographHeader>& headers) {
  Set set{photographsOf(scene, headers), {}};
  for (const PhotographHeader& header : headers) set.truths.push_back(trueDepthOf(scene, header));
  return set;
}

std::vector<PhotographHeader> cameras() {
  std::vector<PhotographHeader> headers = test::camerasOnArc(kCameras, kStepDeg);
  for (PhotographHeader& header : headers) header.depth = kDepths;
  return headers;
}

// The middle of their pictures, because mode `paper` is slow.
std::vector<PhotographHeader> smallCameras() {
  std::vector<PhotographHeader> headers = cameras();
  for (PhotographHeader& header : headers) {
    Pinhole& camera = header.camera;
    camera.cx -= 20, camera.cy -= 14, camera.width = 56, camera.height = 44;
  }
  return headers;
}

StereoResult match(const Set& set, const StereoOptions& options = {}) {
  return computeDepthMaps(PhotographSequence::fromPhotographs(set.photographs), options);
}

StereoOptions paper() {
  StereoOptions options;
  options.mode = StereoOptions::Mode::Paper;
  return options;
}

StereoOptions sweepsOfPlanes() {
  StereoOptions options;
  options.surface_sweeps = 0, options.cross_check = StereoOptions::CrossCheck::Off;
  return options;
}

// Inverse depth by which the picture moves by one pixel in the widest partner, where it moves most.
double inverseDepthOfPixel(const Set& set, const StereoView& view, std::size_t index) {
  std::vector<PhotographHeader> partners;
  for (const std::size_t partner : view.partners) partners.push_back(set.photographs[partner]);
  const auto steps = stereo::paper::raySteps(set.photographs[index], partners, view.depths, 1);
  return steps.step;
}

// Whether there is a surface, and no depth edge near.
bool isSmooth(const Image<float>& truth, int x, int y) {
  for (int v = -kMargin; v <= kMargin; ++v)
    for (int u = -kMargin; u <= kMargin; ++u)
      if (!truth.contains(x + u, y + v) || !(truth(x + u, y + v) > 0) ||
          std::abs(truth(x + u, y + v) - truth(x, y)) > 0.15)
        return false;
  return true;
}

// Partners that see the point of a pixel, a window away from their border.
int partnersThatSee(const Set& set, const StereoView& view, std::size_t index, int x, int y) {
  const Photograph& reference = set.photographs[index];
  const Eigen::Vector3d point =
      reference.world_from_camera * unproject(reference.camera, x, y, double{set.truths[index](x, y)});
  int count = 0;
  for (const std::size_t j : view.partners) {
    const Photograph& partner = set.photographs[j];
    const auto seen = project(partner.camera, partner.world_from_camera.inverse() * point);
    const Image<float>& truth = set.truths[j];
    const int u = nearestPixel(seen->x), v = nearestPixel(seen->y);
    const bool is_inside =
        truth.contains(u - kMargin, v - kMargin) && truth.contains(u + kMargin, v + kMargin);
    count += is_inside && std::abs(double{truth(u, v)} - seen->depth) < 0.1 ? 1 : 0;
  }
  return count;
}

// In pixels, sorted, of the pixels of photographs first … last away from depth edges for which
// is_counted(partners that see it) holds; those without a depth are off by infinity.
template <class Counted>
std::vector<double> errorsOf(const Set& set, const StereoResult& result, std::size_t first, std::size_t last,
                             const Counted& is_counted) {
  std::vector<double> errors;
  for (std::size_t i = first; i <= last; ++i) {
    const StereoView& view = result.views[i];
    const Image<float>& truth = set.truths[i];
    const double pixel = inverseDepthOfPixel(set, view, i);
    for (int y = 0; y < truth.height(); ++y)
      for (int x = 0; x < truth.width(); ++x) {
        if (!isSmooth(truth, x, y) || !is_counted(partnersThatSee(set, view, i, x, y))) continue;
        const float depth = view.view.map.depth(x, y);
        errors.push_back(depth == kInvalidDepth
                             ? INFINITY
                             : std::abs(1 / double{depth} - 1 / double{truth(x, y)}) / pixel);
      }
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

// Of what all partners see.
std::vector<double> errorsOfVisible(const Set& set, const StereoResult& result) {
  return errorsOf(set, result, 0, kCameras - 1, [](int partners) { return partners == kCameras - 1; });
}

double shareBelow(const std::vector<double>& sorted, double limit) {
  return static_cast<double>(std::lower_bound(sorted.begin(), sorted.end(), limit) - sorted.begin()) /
         static_cast<double>(sorted.size());
}

double median(const std::vector<double>& sorted) { return sorted[sorted.size() / 2]; }

void record(const std::string& name, double value) {
  testing::Test::RecordProperty(name, std::to_string(value));
}

struct Agreement {
  double confident = 0, same = 0;
  double share() const { return same / confident; }
};

// Of the pixels with confidence in both: those within half a step of mode `paper`.
Agreement agreementOf(const Set& set, const StereoResult& fast, const StereoResult& slow) {
  Agreement agreement;
  for (std::size_t i = 0; i < fast.views.size(); ++i) {
    const DepthMap &a = fast.views[i].view.map, &b = slow.views[i].view.map;
    const double step = stereo::kPaperStep * inverseDepthOfPixel(set, slow.views[i], i);
    for (std::size_t p = 0; p < a.depth.size(); ++p) {
      if (std::min(a.confidence.data()[p], b.confidence.data()[p]) < 0.5F) continue;
      const double off = std::abs(1 / double{a.depth.data()[p]} - 1 / double{b.depth.data()[p]}) / step;
      ++agreement.confident;
      agreement.same += off <= 0.5 ? 1 : 0;
    }
  }
  return agreement;
}

struct NamedScene {
  std::string name;
  const TexturedScene* scene;
  double gain;  // of the error: the greatest share of that of mode `paper`
};

class FastStereoOn : public testing::TestWithParam<NamedScene> {};

TEST_P(FastStereoOn, WithoutSurfaceSweepsEqualsModePaperAndWithThemIsNoFurtherFromTheTruth) {
  const Set set = setOf(*GetParam().scene, smallCameras());
  const StereoResult slow = match(set, paper()), planes = match(set, sweepsOfPlanes());
  for (std::size_t i = 0; i < planes.views.size(); ++i)
    EXPECT_EQ(planes.views[i].partners, slow.views[i].partners);
  const Agreement agreement = agreementOf(set, planes, slow);
  record("confident", agreement.confident), record("same", agreement.share());
  EXPECT_GT(agreement.confident, 4000);
  EXPECT_GE(agreement.share(), 0.98);

  const std::vector<double> fast_errors = errorsOfVisible(set, match(set)),
                            slow_errors = errorsOfVisible(set, slow);
  record("fast_median_px", median(fast_errors)), record("paper_median_px", median(slow_errors));
  record("fast_within_half_px", shareBelow(fast_errors, 0.5));
  record("paper_within_half_px", shareBelow(slow_errors, 0.5));
  EXPECT_LT(median(fast_errors), GetParam().gain * median(slow_errors));
  EXPECT_GE(shareBelow(fast_errors, 0.5), shareBelow(slow_errors, 0.5));
}

TEST_P(FastStereoOn, ComesWithinHalfAPixelOfTheTruth) {
  const Set set = setOf(*GetParam().scene, cameras());
  const std::vector<double> errors = errorsOfVisible(set, match(set));
  record("pixels", static_cast<double>(errors.size()));
  record("within_half_px", shareBelow(errors, 0.5));
  record("median_px", median(errors));
  EXPECT_GT(errors.size(), 7000u);
  EXPECT_GE(shareBelow(errors, 0.5), 0.95);
}

INSTANTIATE_TEST_SUITE_P(Scenes, FastStereoOn,
                         testing::Values(NamedScene{"Frontal", &kFrontal, 1.5},
                                         NamedScene{"Slanted", &kSlanted, 0.2},
                                         NamedScene{"Ball", &kBall, 0.7}),
                         [](const auto& test) { return test.param.name; });

TEST(FastStereo, WhereHalfThePartnersAreOccludedDepthsAreRight) {
  const Set set = setOf(kOccluded, cameras());
  for (const StereoOptions& options : {StereoOptions{}, sweepsOfPlanes()}) {
    const std::vector<double> errors =
        errorsOf(set, match(set, options), 2, 2, [](int partners) { return partners == 2; });
    record("pixels", static_cast<double>(errors.size()));
    record("within_half_px", shareBelow(errors, 0.5));
    EXPECT_GT(errors.size(), 1000u);
    EXPECT_GT(shareBelow(errors, 0.5), 0.85);
  }
}

}  // namespace
}  // namespace vdbfuse
