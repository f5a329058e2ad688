// SPDX-License-Identifier: Apache-2.0
// Files with random damage are read or refused, never worse. Worth most under the sanitizers.
#include <gtest/gtest.h>

#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::readText;
using test::TemporaryFolder;
using test::writeText;

constexpr int kTrials = 150;

// One to four bytes changed, removed or inserted; sometimes the end cut off.
std::string damaged(std::string text, Random& random) {
  for (std::uint64_t count = 1 + random.below(4); count > 0 && !text.empty(); --count) {
    const std::size_t at = random.below(text.size());
    const char byte = static_cast<char>(random.below(256));
    switch (random.below(5)) {
      case 0:
        text.erase(at, 1);
        break;
      case 1:
        text.insert(at, 1, byte);
        break;
      case 2:
        text.resize(random.below(8) == 0 ? at : text.size());
        break;
      default:
        text[at] = byte;
    }
  }
  return text;
}

// Damages `file` again and again. Returns how often the data set was refused.
int refusals(const std::filesystem::path& folder, const std::string& file) {
  const std::string good = readText(folder / file);
  Random random(7);
  int refused = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    writeText(folder / file, damaged(good, random));
    try {
      const DepthSet set = readDepthSet(folder);
      for (std::size_t i = 0; i < set.views.size(); ++i) set.views.load(i);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  writeText(folder / file, good);
  return refused;
}

TEST(DamagedFiles, OfAnRgbdFolderAreReadOrRefused) {
  const TemporaryFolder folder;
  writePng(folder / "a.depth.png", Image<std::uint16_t>(14, 9, std::uint16_t{1000}));
  writePng(folder / "a.color.png", Image<Rgb8>(14, 9, Rgb8{1, 2, 3}));
  writeText(folder / "a.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  writeText(folder / "intrinsics.txt", "14 0 6.5\n0 14 4.0\n0 0 1\n");
  EXPECT_GT(refusals(folder.path(), "a.depth.png"), kTrials / 2);
  EXPECT_GT(refusals(folder.path(), "a.color.png"), kTrials / 2);
  EXPECT_GT(refusals(folder.path(), "a.pose.txt"), kTrials / 2);
  EXPECT_GT(refusals(folder.path(), "intrinsics.txt"), kTrials / 2);
}

TEST(DamagedFiles, OfAnMvsnetFolderAreReadOrRefused) {
  const TemporaryFolder folder;
  View view;
  view.projection = Pinhole{6, 5, 6, 6, 2.5, 2, {}};
  view.map.depth = Image<float>(6, 5, 2.0f);
  MvsnetWriter(folder.path()).add(view);
  EXPECT_GT(refusals(folder.path(), "cams/00000000_cam.txt"), kTrials / 2);
  // Most bytes of a PFM file are values, and any value is one.
  EXPECT_GT(refusals(folder.path(), "depth_est/00000000.pfm"), 0);
}

}  // namespace
}  // namespace vdbfuse
