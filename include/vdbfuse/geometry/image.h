// SPDX-License-Identifier: Apache-2.0
// A dense raster, row by row from the top. Pixel centres lie at integer (x, y).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdbfuse {

/// Red, green, blue.
using Rgb8 = std::array<std::uint8_t, 3>;

template <class T>
class Image {
 public:
  using Value = T;

  Image() = default;
  Image(int width, int height, const T& value = T{})
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value) {}

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return values_.empty(); }
  std::size_t size() const { return values_.size(); }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  template <class U>
  bool sameSize(const Image<U>& other) const {
    return width_ == other.width() && height_ == other.height();
  }

  /// REQUIRES: contains(x, y).
  T& operator()(int x, int y) { return values_[index(x, y)]; }
  const T& operator()(int x, int y) const { return values_[index(x, y)]; }
  T* row(int y) { return values_.data() + index(0, y); }
  const T* row(int y) const { return values_.data() + index(0, y); }
  T* data() { return values_.data(); }
  const T* data() const { return values_.data(); }
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }
  bool operator==(const Image&) const = default;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0;
  int height_ = 0;
  std::vector<T> values_;
};

}  // namespace vdbfuse
