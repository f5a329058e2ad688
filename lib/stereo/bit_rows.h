// SPDX-License-Identifier: Apache-2.0
// A yes or no for every pixel, 64 of them at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbfuse::stereo {

class BitRows {
 public:
  static constexpr int kBits = 64;

  /// `is`(x, y) of every pixel.
  template <class Is>
  BitRows(int width, int height, const Is& is)
      : height_(height), stride_(static_cast<std::size_t>(words(width) + 2)) {
    bits_.resize(stride_ * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (is(x, y)) bits_[at(x / kBits, y)] |= std::uint64_t{1} << (x % kBits);
  }

  static int words(int width) { return (width + kBits - 1) / kBits; }

  /// Bit i: of the pixel (64·word + i + shift, y); 0 beyond the borders. REQUIRES: |shift| < 64.
  std::uint64_t moved(int word, int y, int shift) const {
    if (y < 0 || y >= height_) return 0;
    const std::uint64_t* here = bits_.data() + at(word, y);
    if (shift > 0) return here[0] >> shift | here[1] << (kBits - shift);
    if (shift < 0) return here[0] << -shift | here[-1] >> (kBits + shift);
    return here[0];
  }

 private:
  std::size_t at(int word, int y) const {  // a word of zeros on either side of a row
    return static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(word) + 1;
  }

  int height_;
  std::size_t stride_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace vdbfuse::stereo
