// SPDX-License-Identifier: Apache-2.0
// A picture of one bit a pixel, for neighbourhoods that are looked at 64 pixels at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace vdbfuse {

class BitImage {
 public:
  BitImage(int width, int height)
      : width_(width),
        height_(height),
        words_((static_cast<std::size_t>(width) + 63) / 64),
        bits_(words_ * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  /// Words of a row; bits beyond the width are 0.
  std::size_t words() const { return words_; }
  std::uint64_t* row(int y) { return bits_.data() + words_ * static_cast<std::size_t>(y); }
  const std::uint64_t* row(int y) const { return bits_.data() + words_ * static_cast<std::size_t>(y); }
  bool operator()(int x, int y) const { return row(y)[x / 64] >> (x % 64) & 1; }
  void set(int x, int y) { row(y)[x / 64] |= std::uint64_t{1} << (x % 64); }

 private:
  int width_, height_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

/// The word of a row with every bit that of its right (step 1) or left (step −1) neighbour; 0 beyond the
/// ends.
inline std::uint64_t besides(const std::uint64_t* row, std::size_t word, std::size_t words, int step) {
  const std::uint64_t before = word > 0 ? row[word - 1] : 0, here = row[word],
                      after = word + 1 < words ? row[word + 1] : 0;
  return step > 0 ? here >> 1 | after << 63 : here << 1 | before >> 63;
}

/// Bits that are set themselves or have one set among the 8 pixels around them.
inline BitImage grown(const BitImage& image) {
  const int height = image.height();
  BitImage wide(image.width(), height), result(wide);
  const std::size_t words = image.words();
  const std::uint64_t last =
      image.width() % 64 == 0 ? ~std::uint64_t{0} : (std::uint64_t{1} << (image.width() % 64)) - 1;
  for (int y = 0; y < height; ++y) {
    const std::uint64_t* from = image.row(y);
    for (std::size_t w = 0; w < words; ++w)
      wide.row(y)[w] = from[w] | besides(from, w, words, 1) | besides(from, w, words, -1);
    wide.row(y)[words - 1] &= last;
  }
  for (int y = 0; y < height; ++y) {
    const std::uint64_t *up = wide.row(std::max(y - 1, 0)), *here = wide.row(y),
                        *down = wide.row(std::min(y + 1, height - 1));
    for (std::size_t w = 0; w < words; ++w) result.row(y)[w] = up[w] | here[w] | down[w];
  }
  return result;
}

/// Bits that are set, as are all of the 8 pixels around them; none at the border.
inline BitImage shrunk(const BitImage& image) {
  const int height = image.height();
  BitImage narrow(image.width(), height), result(narrow);
  const std::size_t words = image.words();
  for (int y = 0; y < height; ++y) {
    const std::uint64_t* from = image.row(y);
    for (std::size_t w = 0; w < words; ++w)
      narrow.row(y)[w] = from[w] & besides(from, w, words, 1) & besides(from, w, words, -1);
  }
  for (int y = 1; y + 1 < height; ++y) {
    const std::uint64_t *up = narrow.row(y - 1), *here = narrow.row(y), *down = narrow.row(y + 1);
    for (std::size_t w = 0; w < words; ++w) result.row(y)[w] = up[w] & here[w] & down[w];
  }
  return result;
}

}  // namespace vdbfuse
