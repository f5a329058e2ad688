// SPDX-License-Identifier: Apache-2.0
// Large arrays that are read at random.
#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace vdbfuse::mincut {

/// An array that is not touched before it is written, so that its pages are made by who fills them; in large
/// pages where the system has them, because the search looks all over it (8 to 12 % of its time).
template <typename T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;
  explicit Buffer(std::size_t size) : values_(allocate(size)), size_(size) {}
  Buffer(const Buffer& other) : Buffer(other.size_) {
    std::copy_n(other.values_.get(), size_, values_.get());
  }
  Buffer(Buffer&&) noexcept = default;
  Buffer& operator=(Buffer other) noexcept {
    values_ = std::move(other.values_);
    size_ = other.size_;
    return *this;
  }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }
  std::size_t size() const { return size_; }
  T* begin() { return values_.get(); }
  T* end() { return values_.get() + size_; }

 private:
  struct Free {
    void operator()(T* values) const { std::free(values); }
  };

  static T* allocate(std::size_t size) {
    constexpr std::size_t kLargePage = std::size_t{1} << 21;
    const std::size_t bytes = size * sizeof(T);
    const bool large = bytes >= 2 * kLargePage;
    const std::size_t alignment = large ? kLargePage : 64;
    const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
    auto* values = static_cast<T*>(std::aligned_alloc(alignment, rounded));
    if (values == nullptr) throw std::bad_alloc();
#ifdef MADV_HUGEPAGE
    if (large) madvise(values, rounded, MADV_HUGEPAGE);  // a wish: no harm where it is not granted
#endif
    return values;
  }

  std::unique_ptr<T[], Free> values_;
  std::size_t size_ = 0;
};

}  // namespace vdbfuse::mincut
