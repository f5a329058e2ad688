// SPDX-License-Identifier: Apache-2.0
// A dense raster, row by row from the top. Pixel centres lie at integer (x, y).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <type_traits>
#include <vector>

namespace vdbfuse {

/// Memory of an image's pixels. Moving an image moves its memory along; a copy lies in plain memory.
template <class T>
class ImageAllocator {
 public:
  // The names that std::allocator_traits asks for. NOLINTBEGIN(readability-identifier-naming)
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  ImageAllocator() = default;
  ImageAllocator(std::pmr::memory_resource* resource) : resource_(resource) {}  // NOLINT: as std::pmr does
  template <class U>
  ImageAllocator(const ImageAllocator<U>& other) : resource_(other.resource()) {}  // NOLINT: a rebind
  T* allocate(std::size_t count) {
    return static_cast<T*>(resource_->allocate(count * sizeof(T), alignof(T)));
  }
  void deallocate(T* values, std::size_t count) {
    resource_->deallocate(values, count * sizeof(T), alignof(T));
  }
  ImageAllocator select_on_container_copy_construction() const { return {}; }
  // NOLINTEND(readability-identifier-naming)
  std::pmr::memory_resource* resource() const { return resource_; }
  bool operator==(const ImageAllocator& other) const { return *resource_ == *other.resource_; }

 private:
  std::pmr::memory_resource* resource_ = std::pmr::new_delete_resource();
};

/// Red, green, blue.
using Rgb8 = std::array<std::uint8_t, 3>;

template <class T>
class Image {
 public:
  using Value = T;

  Image() = default;
  Image(int width, int height, const T& value = T{},
        std::pmr::memory_resource* memory = std::pmr::new_delete_resource())
      : width_(width),
        height_(height),
        values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value, memory) {}
  /// A copy that lies in `memory`.
  Image(const Image& other, std::pmr::memory_resource* memory)
      : width_(other.width_), height_(other.height_), values_(other.values_, memory) {}

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
  /// Where the pixels lie.
  std::pmr::memory_resource* memory() const { return values_.get_allocator().resource(); }
  bool operator==(const Image&) const = default;

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  int width_ = 0;
  int height_ = 0;
  std::vector<T, ImageAllocator<T>> values_;
};

}  // namespace vdbfuse
