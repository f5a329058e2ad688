// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/jpeg.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

// A JPEG of one colour.
std::string encoded(int width, int height, const Rgb8& color) {
  const Image<Rgb8> image(width, height, color);
  tjhandle encoder = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  tjCompress2(encoder, image.data()->data(), width, 0, height, TJPF_RGB, &bytes, &size, TJSAMP_444, 95, 0);
  std::string result(reinterpret_cast<const char*>(bytes), size);
  tjFree(bytes);
  tjDestroy(encoder);
  return result;
}

TEST(Jpeg, ColourComesBackInOrder) {
  const TemporaryFolder folder;
  writeText(folder / "a.jpg", encoded(24, 16, {200, 100, 30}));
  const Image<Rgb8> image = readJpeg(folder / "a.jpg");
  EXPECT_EQ(image.width(), 24);
  EXPECT_EQ(image.height(), 16);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(image(20, 12)[c], (Rgb8{200, 100, 30}[c]), 3);
}

TEST(Jpeg, TruncatedFileSaysWhereItEnds) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.jpg";
  const std::string good = encoded(64, 64, {200, 100, 30});
  writeText(path, good.substr(0, good.size() - 10));
  EXPECT_EQ(messageOf<IoError>([&] { readJpeg(path); }),
            path.string() + ": byte " + std::to_string(good.size() - 10) +
                ": expected pixels of a 64x64 image, found the end of the file");
}

TEST(Jpeg, OtherFilesAreNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "a.jpg";
  writeText(path, "");
  EXPECT_EQ(messageOf<IoError>([&] { readJpeg(path); }),
            path.string() + ": expected a JPEG file, found an empty file");
  writeText(path, "no picture");
  EXPECT_EQ(
      messageOf<IoError>([&] { readJpeg(path); }).find(path.string() + ": expected a JPEG file, found "), 0u);
}

}  // namespace
}  // namespace vdbfuse
