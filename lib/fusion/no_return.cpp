// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/no_return.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {
namespace {

constexpr int kRadius = 4, kSide = 2 * kRadius + 1;

using Bytes = std::vector<std::uint8_t>;

// out[x] = padded[x] + … + padded[x + 8] in four sums of whole rows, sixteen and more pixels an instruction.
void addNine(const std::uint8_t* padded, std::size_t width, Bytes& pairs, Bytes& fours, std::uint8_t* out) {
  static_assert(kSide == 9);
  for (std::size_t x = 0; x < width + 6; ++x) pairs[x] = static_cast<std::uint8_t>(padded[x] + padded[x + 1]);
  for (std::size_t x = 0; x < width + 4; ++x) fours[x] = static_cast<std::uint8_t>(pairs[x] + pairs[x + 2]);
  for (std::size_t x = 0; x < width; ++x)
    out[x] = static_cast<std::uint8_t>(fours[x] + fours[x + 4] + padded[x + 8]);
}

// Ones of each pixel's row within kRadius of it.
Image<std::uint8_t> countAlongRows(const Image<std::uint8_t>& mask) {
  const auto width = static_cast<std::size_t>(mask.width());
  Bytes padded(width + 2 * kRadius), pairs(padded.size()), fours(padded.size());
  Image<std::uint8_t> counts(mask.width(), mask.height());
  for (int y = 0; y < mask.height(); ++y) {
    std::copy_n(mask.row(y), width, padded.begin() + kRadius);
    addNine(padded.data(), width, pairs, fours, counts.row(y));
  }
  return counts;
}

// 1 where the centred 9×9 window holds more than limit(its pixels inside the image) ones.
template <class Limit>
Image<std::uint8_t> moreThan(const Image<std::uint8_t>& mask, Limit limit) {
  const int width = mask.width(), height = mask.height();
  const auto extent = [](int i, int count) {
    return std::min(i + kRadius, count - 1) - std::max(i - kRadius, 0) + 1;
  };
  const Image<std::uint8_t> rows = countAlongRows(mask);
  Bytes ones(static_cast<std::size_t>(width)), limits(ones);
  const auto accumulate = [&](int y, int sign) {
    if (y < 0 || y >= height) return;
    const std::uint8_t* row = rows.row(y);
    std::transform(ones.begin(), ones.end(), row, ones.begin(), [sign](std::uint8_t sum, std::uint8_t count) {
      return static_cast<std::uint8_t>(sum + sign * count);
    });
  };
  Image<std::uint8_t> result(width, height);
  for (int y = 0; y < kRadius; ++y) accumulate(y, 1);
  for (int y = 0, lines = 0; y < height; ++y) {
    accumulate(y + kRadius, 1);
    if (extent(y, height) != lines) {
      lines = extent(y, height);
      for (int x = 0; x < width; ++x)
        limits[static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(limit(extent(x, width) * lines));
    }
    std::transform(ones.begin(), ones.end(), limits.begin(), result.row(y), std::greater<>());
    accumulate(y - kRadius, -1);
  }
  return result;
}

// Keeps what is joined to the border through 4-neighbours, a run of a row at a time.
class BorderFill {
 public:
  explicit BorderFill(const Image<std::uint8_t>& mask) : mask_(mask), result_(mask.width(), mask.height()) {}

  Image<std::uint8_t> fill() {
    const int right = mask_.width() - 1, bottom = mask_.height() - 1;
    for (int x = 0; x <= right; ++x) visit(x, 0), visit(x, bottom);
    for (int y = 0; y <= bottom; ++y) visit(0, y), visit(right, y);
    while (!seeds_.empty()) {
      const auto [x, y] = seeds_.back();
      seeds_.pop_back();
      if (isNew(x, y)) fillRun(x, y);
    }
    return std::move(result_);
  }

 private:
  bool isNew(int x, int y) const { return mask_(x, y) && !result_(x, y); }
  void visit(int x, int y) {
    if (isNew(x, y)) seeds_.push_back({x, y});
  }

  void fillRun(int x, int y) {
    const std::uint8_t* row = mask_.row(y);
    int begin = x;
    while (begin > 0 && row[begin - 1]) --begin;
    const int end = endOfRun(row, x, mask_.width());
    std::fill(result_.row(y) + begin, result_.row(y) + end, std::uint8_t{1});
    if (y > 0) visitRuns(begin, end, y - 1);
    if (y + 1 < mask_.height()) visitRuns(begin, end, y + 1);
  }

  // The first pixel of each run of new ones within [begin, end).
  void visitRuns(int begin, int end, int y) {
    const std::uint8_t* row = mask_.row(y);
    for (int x = begin; x < end; x = endOfRun(row, x, end)) {
      x = find(row, x, end, 1);
      if (x < end) visit(x, y);
    }
  }

  static int endOfRun(const std::uint8_t* row, int x, int end) { return find(row, x, end, 0); }

  // The first pixel from x on with a value; `end` when there is none.
  static int find(const std::uint8_t* row, int x, int end, int value) {
    const void* found = std::memchr(row + x, value, static_cast<std::size_t>(end - x));
    return found == nullptr ? end : static_cast<int>(static_cast<const std::uint8_t*>(found) - row);
  }

  const Image<std::uint8_t>& mask_;
  Image<std::uint8_t> result_;
  std::vector<std::array<int, 2>> seeds_;
};

}  // namespace

Image<std::uint8_t> emptyRegions(const Image<float>& depth, const Image<float>& outlier,
                                 const Image<std::uint8_t>& missed) {
  constexpr float kProbablyWrong = 0.75f;
  Image<std::uint8_t> missing(depth.width(), depth.height());
  std::transform(depth.begin(), depth.end(), missing.begin(), [](float d) { return d == kInvalidDepth; });
  Image<std::uint8_t> passable = missing;
  if (!outlier.empty()) {
    std::transform(
        passable.begin(), passable.end(), outlier.begin(), passable.begin(),
        [](std::uint8_t pass, float e) { return static_cast<std::uint8_t>(pass | (e > kProbablyWrong)); });
  }
  const auto all = [](int pixels) { return pixels - 1; };
  const auto most = [](int pixels) { return pixels / 2; };
  const auto few = [](int pixels) { return pixels / 16; };
  const auto none = [](int) { return 0; };
  Image<std::uint8_t> squares = moreThan(passable, all);
  const Image<std::uint8_t> mostly_missing = moreThan(missing, most);
  std::transform(squares.begin(), squares.end(), mostly_missing.begin(), squares.begin(), std::bit_and<>());
  if (!missed.empty()) {
    const Image<std::uint8_t> holes = moreThan(missed, few);
    std::transform(squares.begin(), squares.end(), holes.begin(), squares.begin(), std::greater<>());
  }
  return BorderFill(moreThan(squares, none)).fill();
}

double borderShare(const Image<std::uint8_t>& mask) {
  if (mask.empty()) return 0;
  int inside = 0;
  for (int x = 0; x < mask.width(); ++x) inside += mask(x, 0) + mask(x, mask.height() - 1);
  for (int y = 0; y < mask.height(); ++y) inside += mask(0, y) + mask(mask.width() - 1, y);
  return static_cast<double>(inside) / (2.0 * (mask.width() + mask.height()));
}

}  // namespace vdbfuse
