// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/no_return.h"

#include <algorithm>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {
namespace {

constexpr int kRadius = 4;

// Minimum (or maximum) over a centred window along one line; what lies outside the image does not count.
template <class Pick>
void filterLine(const std::uint8_t* in, std::uint8_t* out, int count, int stride, Pick pick) {
  for (int i = 0; i < count; ++i) {
    std::uint8_t value = in[i * stride];
    for (int k = std::max(0, i - kRadius); k <= std::min(count - 1, i + kRadius); ++k) {
      value = pick(value, in[k * stride]);
    }
    out[i * stride] = value;
  }
}

template <class Pick>
Image<std::uint8_t> filterSquare(const Image<std::uint8_t>& mask, Pick pick) {
  Image<std::uint8_t> rows(mask.width(), mask.height()), both(mask.width(), mask.height());
  for (int y = 0; y < mask.height(); ++y) filterLine(mask.row(y), rows.row(y), mask.width(), 1, pick);
  for (int x = 0; x < mask.width(); ++x)
    filterLine(rows.data() + x, both.data() + x, mask.height(), mask.width(), pick);
  return both;
}

// Keeps what is joined to the border through 4-neighbours.
Image<std::uint8_t> joinedToBorder(const Image<std::uint8_t>& mask) {
  Image<std::uint8_t> result(mask.width(), mask.height());
  std::vector<std::array<int, 2>> stack;
  const auto visit = [&](int x, int y) {
    if (!mask.contains(x, y) || !mask(x, y) || result(x, y)) return;
    result(x, y) = 1;
    stack.push_back({x, y});
  };
  for (int x = 0; x < mask.width(); ++x) visit(x, 0), visit(x, mask.height() - 1);
  for (int y = 0; y < mask.height(); ++y) visit(0, y), visit(mask.width() - 1, y);
  while (!stack.empty()) {
    const auto [x, y] = stack.back();
    stack.pop_back();
    visit(x - 1, y), visit(x + 1, y), visit(x, y - 1), visit(x, y + 1);
  }
  return result;
}

}  // namespace

Image<std::uint8_t> emptyRegions(const Image<float>& depth) {
  Image<std::uint8_t> missing(depth.width(), depth.height());
  std::transform(depth.begin(), depth.end(), missing.begin(),
                 [](float d) { return static_cast<std::uint8_t>(d == kInvalidDepth); });
  const auto smaller = [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); };
  const auto larger = [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); };
  return joinedToBorder(filterSquare(filterSquare(missing, smaller), larger));
}

double borderShare(const Image<std::uint8_t>& mask) {
  if (mask.empty()) return 0;
  int inside = 0;
  for (int x = 0; x < mask.width(); ++x) inside += mask(x, 0) + mask(x, mask.height() - 1);
  for (int y = 0; y < mask.height(); ++y) inside += mask(0, y) + mask(mask.width() - 1, y);
  return static_cast<double>(inside) / (2.0 * (mask.width() + mask.height()));
}

}  // namespace vdbfuse
