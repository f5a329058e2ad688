// SPDX-License-Identifier: Apache-2.0
// A TSDF volume on disk: float grids that other tools read, with what is needed to go on in their metadata.
// Numbers of the half storage are floats exactly, and come back as they were.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "fusion/tsdf_state.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr const char* kColorNames[] = {"red", "green", "blue", "color_weight"};

std::string text(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  return {digits, end};
}

// What a file says of its volume.
class Words {
 public:
  Words(const std::filesystem::path& path, const std::map<std::string, std::string>& words)
      : path_(path), words_(words) {}

  const std::string& word(const std::string& key) const {
    const auto found = words_.find(key);
    if (found == words_.end())
      throw IoError(path_, "",
                    "a volume written by vdbfuse, with '" + key + "' in the metadata of its grid 'surface'",
                    "none");
    return found->second;
  }
  double number(const std::string& key) const {
    const std::string& digits = word(key);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value))
      throw IoError(path_, "metadata '" + key + "'", "a number", "'" + digits + "'");
    return value;
  }
  bool is(const std::string& key, const std::string& yes, const std::string& no) const {
    const std::string& found = word(key);
    if (found != yes && found != no)
      throw IoError(path_, "metadata '" + key + "'", "'" + yes + "' or '" + no + "'", "'" + found + "'");
    return found == yes;
  }

 private:
  const std::filesystem::path& path_;
  const std::map<std::string, std::string>& words_;
};

const char* const kAxes[] = {"x", "y", "z"};

void describe(const TsdfVolumeState& state, std::map<std::string, std::string>& words) {
  const TsdfOptions& options = state.options;
  words["voxel"] = text(state.frame.voxel);
  for (int a = 0; a < 3; ++a) words[std::string("offset_") + kAxes[a]] = text(state.frame.offset[a]);
  words["truncation"] = text(options.truncation);
  words["carved"] = state.is_carved ? "yes" : "no";
  words["storage"] = options.storage == TsdfStorage::Half ? "half" : "single";
  words["colors"] = options.colors == TsdfColors::Keep ? "keep" : "none";
  words["domain"] = options.domain ? "box" : "none";
  if (!options.domain) return;
  for (int a = 0; a < 3; ++a) {
    words[std::string("domain_low_") + kAxes[a]] = text(options.domain->min()[a]);
    words[std::string("domain_high_") + kAxes[a]] = text(options.domain->max()[a]);
  }
}

std::pair<GridFrame, TsdfOptions> described(const Words& words) {
  GridFrame frame;
  TsdfOptions options;
  frame.voxel = words.number("voxel");
  for (int a = 0; a < 3; ++a) frame.offset[a] = words.number(std::string("offset_") + kAxes[a]);
  options.truncation = words.number("truncation");
  options.storage = words.is("storage", "half", "single") ? TsdfStorage::Half : TsdfStorage::Single;
  options.colors = words.is("colors", "keep", "none") ? TsdfColors::Keep : TsdfColors::None;
  if (words.is("domain", "box", "none")) {
    Eigen::Vector3d low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = words.number(std::string("domain_low_") + kAxes[a]);
      high[a] = words.number(std::string("domain_high_") + kAxes[a]);
    }
    options.domain = Box(low, high);
  }
  return {frame, options};
}

std::vector<ScalarGrid> colorGrids(const TsdfVolumeState& state, const ScalarGrid& like) {
  std::vector<Index3> origins;
  for (std::size_t i = 0; i < like.leafCount(); ++i) origins.push_back(like.leaf(i).origin);
  std::vector<ScalarGrid> grids;
  for (std::size_t c = 0; c < 4; ++c) {
    ScalarGrid& grid = grids.emplace_back(kColorNames[c], state.frame, 0.0f, origins);
    grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
      const std::uint16_t* v = state.colorsOf(*state.find(leaf.origin));
      for (std::size_t i = 0; i < kTsdfLeaf; ++i)
        leaf.values[i] = static_cast<float>(v[4 * i + c]) / (c < 3 ? kColorOne : kColorWeight);
    });
  }
  return grids;
}

void fill(TsdfVolumeState::SingleTree& tree, std::size_t leaf, const ScalarGrid::Leaf& distance,
          const ScalarGrid::Leaf& weight, double) {
  float* v = tree.values(leaf);
  for (std::size_t i = 0; i < kTsdfLeaf; ++i) {
    const bool is_known = weight.values[i] > 0 && !std::isnan(distance.values[i]);
    v[2 * i] = is_known ? distance.values[i] : 0.0f;
    v[2 * i + 1] = is_known ? weight.values[i] : 0.0f;
  }
}

void fill(TsdfVolumeState::HalfTree& tree, std::size_t leaf, const ScalarGrid::Leaf& distance,
          const ScalarGrid::Leaf& weight, double truncation) {
  std::int16_t* v = tree.values(leaf);
  const float scale = kHalfOne / static_cast<float>(truncation);
  const auto narrow = [](float x) {
    return static_cast<std::int16_t>(std::clamp(std::nearbyint(x), -kHalfOne, kHalfOne));
  };
  for (std::size_t i = 0; i < kTsdfLeaf; ++i) {
    const bool is_known = weight.values[i] > 0 && !std::isnan(distance.values[i]);
    v[2 * i] = is_known ? narrow(distance.values[i] * scale) : std::int16_t{0};
    v[2 * i + 1] = is_known ? narrow(weight.values[i] * kHalfWeight) : std::int16_t{0};
  }
}

// The leaf of a grid that the others of its file have, too.
ScalarGrid::Leaf leafAt(const std::filesystem::path& path, const ScalarGrid& grid, const Index3& origin) {
  const auto leaf = grid.findLeaf(origin);
  if (!leaf) throw IoError(path, "grid '" + grid.name() + "'", "the leaves of grid 'weight'", "one less");
  return grid.leaf(*leaf);
}

void fillColors(const std::filesystem::path& path, TsdfVolumeState& state) {
  for (std::size_t c = 0; c < 4; ++c) {
    const ScalarGrid grid = readGrid(path, kColorNames[c]);
    for (std::size_t i = 0; i < grid.leafCount(); ++i) {
      const ScalarGrid::Leaf leaf = grid.leaf(i);
      const auto number = state.find(leaf.origin);
      if (!number) continue;
      std::uint16_t* v = state.colorsOf(*number);
      for (std::size_t k = 0; k < kTsdfLeaf; ++k)
        v[4 * k + c] = static_cast<std::uint16_t>(
            std::clamp(std::nearbyint(leaf.values[k] * (c < 3 ? kColorOne : kColorWeight)), 0.0f, 65535.0f));
    }
  }
}

}  // namespace

std::vector<ScalarGrid> TsdfVolume::grids() const {
  const TsdfVolumeState& state = impl_->state;
  std::vector<ScalarGrid> grids;
  grids.push_back(distance());
  describe(state, grids[0].metadata());
  grids.push_back(weight());
  if (state.colors) {
    for (ScalarGrid& grid : colorGrids(state, grids[1])) grids.push_back(std::move(grid));
  }
  return grids;
}

void TsdfVolume::write(const std::filesystem::path& path) const {
  const std::vector<ScalarGrid> all = grids();
  std::vector<const ScalarGrid*> pointers;
  for (const ScalarGrid& grid : all) pointers.push_back(&grid);
  writeGrids(path, pointers);
}

TsdfVolume TsdfVolume::read(const std::filesystem::path& path) {
  const ScalarGrid distance = readGrid(path, "surface"), weight = readGrid(path, "weight");
  const Words words(path, distance.metadata());
  const auto [frame, options] = described(words);
  const std::vector<std::string> problems = validate(options);
  if (!problems.empty()) throw IoError(path, "metadata", "usable options", problems.front());
  TsdfVolume volume(frame, options);
  TsdfVolumeState& state = volume.impl_->state;
  state.changes = 1;
  state.is_carved = words.is("carved", "yes", "no");
  for (std::size_t i = 0; i < weight.leafCount(); ++i) {
    const ScalarGrid::Leaf weights = weight.leaf(i);
    const ScalarGrid::Leaf distances = leafAt(path, distance, weights.origin);
    const std::uint32_t leaf = state.insert(weights.origin);
    state.last_change[leaf] = state.changes;
    std::visit([&, truncation =
                       options.truncation](auto& tree) { fill(tree, leaf, distances, weights, truncation); },
               state.voxels);
  }
  if (state.colors) fillColors(path, state);
  return volume;
}

}  // namespace vdbfuse
