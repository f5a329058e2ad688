// SPDX-License-Identifier: Apache-2.0
// Silhouettes (section 2 of the paper): what lies outside them is free, whatever was measured there.
#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/scan_scenes.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace vdbfuse {
namespace {

// A box seen by few views; with eight holes in each about half of the depth is missing.
struct HoledScan {
  Scene scene = makeScene("box");
  std::vector<SyntheticView> scan;

  explicit HoledScan(Background background = Background::None, int holes = 8) {
    SynthOptions options;
    options.views = 8, options.noise_scale = 0.002, options.background = background;
    options.confidence = ConfidenceKind::None;
    scan = test::smallScan(scene, options);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      Random random(3, i);
      for (int hole = 0; hole < holes; ++hole)
        cutDisc(random.uniform(32, 96), random.uniform(14.4, 81.6), scan[i]);
    }
  }

  static void cutDisc(double cx, double cy, SyntheticView& view) {
    Image<float>& depth = view.view.map.depth;
    for (int y = 0; y < depth.height(); ++y)
      for (int x = 0; x < depth.width(); ++x)
        if (std::hypot(x - cx, y - cy) < 12) depth(x, y) = kInvalidDepth;
  }

  std::vector<View> masked() const {
    std::vector<View> views = test::viewsOf(scan);
    for (std::size_t i = 0; i < views.size(); ++i) views[i].map.mask = scan[i].object;
    return views;
  }

  double iou(std::vector<View> views, JudgeOptions::NoReturn no_return = JudgeOptions::NoReturn::Auto) const {
    ReconstructOptions options;
    options.judge.no_return = no_return;
    options.voxel = 1.0 / 64;
    options.domain = Box(Eigen::Vector3d::Constant(-0.55), Eigen::Vector3d::Constant(0.55));
    options.outliers = 0.02;  // every depth is right: what is asked here is what the masks say
    return test::iouOf(reconstruct(ViewSequence::fromViews(std::move(views)), options).mesh, scene.truth);
  }
};

TEST(SilhouetteMasks, HoldAnObjectWhoseDepthIsFullOfHoles) {
  const HoledScan holed;
  EXPECT_GT(holed.iou(holed.masked()), 0.95);
  EXPECT_LT(holed.iou(test::viewsOf(holed.scan), JudgeOptions::NoReturn::Free), 0.5);  // without them
}

// Joined to the border of the image they look like the space around the object; the other views know better.
TEST(NoReturns, HolesThroughWhichOthersMeasureTheObjectAreNotEmptySpace) {
  const HoledScan holed;
  EXPECT_GT(holed.iou(test::viewsOf(holed.scan)), 0.95);
}

TEST(SilhouetteMasks, LeaveTheMeasuredBackgroundOut) {
  const HoledScan holed(Background::Wall);
  const double with = holed.iou(holed.masked());
  EXPECT_GT(with, 0.9);
}

// Where two views or more deny what it says. With half of the depth missing there are places where fewer do,
// and the object may go.
TEST(SilhouetteMasks, OneThatIsWrongDoesNotCarveWhatOthersMeasured) {
  const HoledScan holed(Background::None, 2);
  const double right = holed.iou(holed.masked());
  for (const std::size_t wrong : {0, 2, 5}) {
    std::vector<View> views = holed.masked();
    Image<std::uint8_t>& mask = views[wrong].map.mask;  // its right half says: nothing there
    for (int y = 0; y < mask.height(); ++y)
      for (int x = mask.width() / 2; x < mask.width(); ++x) mask(x, y) = 0;
    EXPECT_GT(holed.iou(std::move(views)), right - 0.01) << wrong;
  }
}

}  // namespace
}  // namespace vdbfuse
