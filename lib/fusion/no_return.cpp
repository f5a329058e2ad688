// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/no_return.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {
namespace {

constexpr int kRadius = 4;

// Number of ones in a centred window; what lies outside the image does not count.
using Counts = std::vector<std::uint8_t>;

void countAlongRow(const std::uint8_t* row, int width, Counts& counts) {
  int count = 0;
  for (int x = 0; x < std::min(kRadius, width); ++x) count += row[x];
  for (int x = 0; x < width; ++x) {
    if (x + kRadius < width) count += row[x + kRadius];
    counts[static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(count);
    if (x >= kRadius) count -= row[x - kRadius];
  }
}

// 1 where ones(x, y), the number of ones in the square window, satisfies keep(ones, pixels of the window).
template <class Keep>
Image<std::uint8_t> filterSquare(const Image<std::uint8_t>& mask, Keep keep) {
  const int width = mask.width(), height = mask.height();
  const std::size_t columns = static_cast<std::size_t>(width);
  const auto extent = [](int i, int count) {
    return std::min(i + kRadius, count - 1) - std::max(i - kRadius, 0) + 1;
  };
  std::vector<int> extents(columns);
  for (int x = 0; x < width; ++x) extents[static_cast<std::size_t>(x)] = extent(x, width);
  std::vector<Counts> rows(static_cast<std::size_t>(height), Counts(columns));
  std::vector<int> ones(columns, 0);
  for (int y = 0; y < height; ++y) countAlongRow(mask.row(y), width, rows[static_cast<std::size_t>(y)]);
  const auto accumulate = [&](int y, int sign) {
    if (y < 0 || y >= height) return;
    const Counts& row = rows[static_cast<std::size_t>(y)];
    for (std::size_t x = 0; x < columns; ++x) ones[x] += sign * row[x];
  };
  Image<std::uint8_t> result(width, height);
  for (int y = 0; y < kRadius; ++y) accumulate(y, 1);
  for (int y = 0; y < height; ++y) {
    accumulate(y + kRadius, 1);
    const int lines = extent(y, height);
    std::uint8_t* row = result.row(y);
    for (std::size_t x = 0; x < columns; ++x) row[x] = keep(ones[x], extents[x] * lines);
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
    int begin = x, end = x + 1;
    while (begin > 0 && mask_(begin - 1, y)) --begin;
    while (end < mask_.width() && mask_(end, y)) ++end;
    std::fill(result_.row(y) + begin, result_.row(y) + end, std::uint8_t{1});
    if (y > 0) visitRuns(begin, end, y - 1);
    if (y + 1 < mask_.height()) visitRuns(begin, end, y + 1);
  }

  // The first pixel of each run of new ones within [begin, end).
  void visitRuns(int begin, int end, int y) {
    for (int x = begin; x < end; ++x) {
      if (x == begin || !mask_(x - 1, y)) visit(x, y);
    }
  }

  const Image<std::uint8_t>& mask_;
  Image<std::uint8_t> result_;
  std::vector<std::array<int, 2>> seeds_;
};

}  // namespace

Image<std::uint8_t> emptyRegions(const Image<float>& depth, const Image<float>& outlier,
                                 const Image<std::uint8_t>& missed) {
  constexpr float kProbablyWrong = 0.75f;
  Image<std::uint8_t> missing(depth.width(), depth.height()), passable(depth.width(), depth.height());
  for (std::size_t p = 0; p < depth.size(); ++p) {
    missing.data()[p] = depth.data()[p] == kInvalidDepth;
    passable.data()[p] = missing.data()[p] || (!outlier.empty() && outlier.data()[p] > kProbablyWrong);
  }
  const auto all = [](int ones, int pixels) { return static_cast<std::uint8_t>(ones == pixels); };
  const auto most = [](int ones, int pixels) { return static_cast<std::uint8_t>(2 * ones > pixels); };
  const auto any = [](int ones, int) { return static_cast<std::uint8_t>(ones > 0); };
  Image<std::uint8_t> squares = filterSquare(passable, all);
  const Image<std::uint8_t> mostly_missing = filterSquare(missing, most);
  std::transform(squares.begin(), squares.end(), mostly_missing.begin(), squares.begin(), std::bit_and<>());
  if (!missed.empty()) {
    const auto few = [](int ones, int pixels) { return static_cast<std::uint8_t>(16 * ones <= pixels); };
    const Image<std::uint8_t> unseen = filterSquare(missed, few);
    std::transform(squares.begin(), squares.end(), unseen.begin(), squares.begin(), std::bit_and<>());
  }
  return BorderFill(filterSquare(squares, any)).fill();
}

double borderShare(const Image<std::uint8_t>& mask) {
  if (mask.empty()) return 0;
  int inside = 0;
  for (int x = 0; x < mask.width(); ++x) inside += mask(x, 0) + mask(x, mask.height() - 1);
  for (int y = 0; y < mask.height(); ++y) inside += mask(0, y) + mask(mask.width() - 1, y);
  return static_cast<double>(inside) / (2.0 * (mask.width() + mask.height()));
}

}  // namespace vdbfuse
