// SPDX-License-Identifier: Apache-2.0
#include "pipeline/packed_images.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

// Numbers different depths in the order in which they come: a hash table of open addresses.
class Numbering {
 public:
  /// `most`: depths that may be numbered, up to 65536.
  explicit Numbering(std::size_t most) : most_(std::min<std::size_t>(most, 1 << 16)) {}

  /// Nothing once there are more.
  std::optional<std::uint16_t> numberOf(float depth) {
    const auto bits = std::bit_cast<std::uint32_t>(depth);
    for (std::size_t slot = (bits * kMultiplier) >> (32 - kBits);; slot = (slot + 1) & (kSlots - 1)) {
      if (numbers_[slot] == kFree) {
        if (depths_.size() == most_) return std::nullopt;
        numbers_[slot] = static_cast<std::uint32_t>(depths_.size());
        depths_.push_back(depth);
        return static_cast<std::uint16_t>(numbers_[slot]);
      }
      if (std::bit_cast<std::uint32_t>(depths_[numbers_[slot]]) == bits)
        return static_cast<std::uint16_t>(numbers_[slot]);
    }
  }
  const std::vector<float>& depths() const { return depths_; }

 private:
  static constexpr int kBits = 18;
  static constexpr std::size_t kSlots = std::size_t{1} << kBits;
  static constexpr std::uint32_t kMultiplier = 2654435769u;  // 2³²/golden ratio
  static constexpr std::uint32_t kFree = 0xffffffff;
  std::size_t most_;
  std::vector<std::uint32_t> numbers_ = std::vector<std::uint32_t>(kSlots, kFree);
  std::vector<float> depths_;
};

// Empty where there are too many depths for it to be worth it.
struct Coded {
  Image<std::uint16_t> codes;
  Image<float> table;
};
Coded encode(const Image<float>& depth, std::pmr::memory_resource* memory) {
  Numbering numbering(depth.size() / 2);
  Image<std::uint16_t> codes(depth.width(), depth.height(), 0, memory);
  for (std::size_t p = 0; p < depth.size(); ++p) {
    const auto number = numbering.numberOf(depth.data()[p]);
    if (!number) return {};
    codes.data()[p] = *number;
  }
  const std::vector<float>& depths = numbering.depths();
  Image<float> table(static_cast<int>(depths.size()), 1, 0.0f, memory);
  std::copy(depths.begin(), depths.end(), table.begin());
  return {std::move(codes), std::move(table)};
}

// Calls function(image) for each image of a map.
template <class Map, class Function>
void forEachImage(Map& map, const Function& function) {
  function(map.depth), function(map.confidence), function(map.color), function(map.mask);
  for (auto& alternative : map.alternatives) function(alternative.depth), function(alternative.share);
}

}  // namespace

PackedImages::PackedImages(const DepthMap& map, std::shared_ptr<std::pmr::memory_resource> memory)
    : memory_(std::move(memory)) {
  std::pmr::memory_resource* place = memory_.get();
  Coded coded = encode(map.depth, place);
  codes_ = std::move(coded.codes), table_ = std::move(coded.table);
  if (table_.empty()) rest_.depth = Image(map.depth, place);
  rest_.confidence = Image(map.confidence, place);
  rest_.color = Image(map.color, place);
  rest_.mask = Image(map.mask, place);
  for (const DepthAlternative& other : map.alternatives)
    rest_.alternatives.push_back({Image(other.depth, place), Image(other.share, place)});
  letGo(codes_), letGo(table_);
  forEachImage(rest_, [](const auto& image) { letGo(image); });
}

DepthMap PackedImages::unpack() const {
  DepthMap map = rest_;
  forEachImage(rest_, [](const auto& image) { letGo(image); });
  if (table_.empty()) return map;
  map.depth = Image<float>(codes_.width(), codes_.height());
  for (std::size_t p = 0; p < codes_.size(); ++p) map.depth.data()[p] = table_.data()[codes_.data()[p]];
  letGo(codes_), letGo(table_);
  return map;
}

std::size_t PackedImages::bytes() const {
  std::size_t sum = codes_.size() * sizeof(std::uint16_t) + table_.size() * sizeof(float);
  forEachImage(rest_, [&](const auto& image) { sum += image.size() * sizeof(*image.data()); });
  return sum;
}

}  // namespace vdbfuse
