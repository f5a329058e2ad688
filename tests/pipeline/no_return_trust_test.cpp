// SPDX-License-Identifier: Apache-2.0
// When a missing depth means empty space: an object before nothing, not a room with dark patches.
#include <gtest/gtest.h>

#include <algorithm>

#include "io/shared_data.h"
#include "pipeline/scan_scenes.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {
namespace {

// Share of all pixels that are taken for empty space.
double emptyShare(const ViewSequence& views) {
  ReconstructOptions options;
  options.judge.denial = JudgeOptions::Denial::Skip;
  const JudgedScan scan = judgeScan(views, options);
  double empty = 0, all = 0;
  for (const JudgedView& view : scan.judgement.judged.views) {
    empty += static_cast<double>(std::count(view.look.begin(), view.look.end(), Look::Empty));
    all += static_cast<double>(view.look.size());
  }
  return empty / all;
}

// Large patches from which nothing comes back, at the border of the image as well.
void addDarkPatches(std::vector<View>& views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    Random random(5, i);
    Image<float>& depth = views[i].map.depth;
    for (int patch = 0; patch < 4; ++patch) {
      const int x0 = static_cast<int>(random.below(static_cast<std::uint64_t>(depth.width() - 20)));
      const int y0 = patch % 2 == 0 ? 0 : depth.height() - 24;
      for (int y = y0; y < y0 + 24; ++y)
        for (int x = x0; x < x0 + 20; ++x) depth(x, y) = kInvalidDepth;
    }
  }
}

std::vector<View> scan(Arc arc, Background background = Background::None) {
  SynthOptions options;
  options.views = 12, options.arc = arc, options.background = background;
  return test::viewsOf(test::smallScan(makeScene("figure", {1.0 / 64}), options));
}

TEST(NoReturnTrust, AnObjectOnATurntableBeforeNothingIsSurroundedByEmptySpace) {
  EXPECT_GT(emptyShare(ViewSequence::fromViews(scan(Arc::Ring))), 0.3);
}

TEST(NoReturnTrust, SoItIsWhenADarkPatchHidesAPartOfTheObject) {
  std::vector<View> views = scan(Arc::Ring);
  addDarkPatches(views);
  EXPECT_GT(emptyShare(ViewSequence::fromViews(std::move(views))), 0.3);
}

TEST(NoReturnTrust, DarkPatchesOfARoomAreNotEmptySpace) {
  std::vector<View> views = scan(Arc::Room);
  addDarkPatches(views);
  EXPECT_EQ(emptyShare(ViewSequence::fromViews(std::move(views))), 0);
}

TEST(NoReturnTrust, NorAreThoseOfAnObjectBeforeAMeasuredWall) {
  std::vector<View> views = scan(Arc::Ring, Background::Wall);
  addDarkPatches(views);
  EXPECT_EQ(emptyShare(ViewSequence::fromViews(std::move(views))), 0);
}

TEST(NoReturnTrust, NorAreThoseOfARealKitchen) {
  const auto kitchen = test::sharedData("kitchen-rgbd");
  if (!kitchen) GTEST_SKIP() << "kitchen-rgbd is not among the real data";
  ReadOptions options;
  options.color = ReadOptions::Color::Skip;
  const ViewSequence views = readDepthSet(*kitchen, options).views.first(3);
  std::size_t missing = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View view = views.load(i);
    missing +=
        static_cast<std::size_t>(std::count(view.map.depth.begin(), view.map.depth.end(), kInvalidDepth));
  }
  EXPECT_GT(missing, 5000u);  // or there is nothing to trust
  EXPECT_EQ(emptyShare(views), 0);
}

}  // namespace
}  // namespace vdbfuse
