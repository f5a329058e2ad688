// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_decoder.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "formats/scan_grid.h"

namespace vdbfuse {
namespace {

Eigen::Vector3d fromSpherical(const Eigen::Vector3d& v) {
  const double range = v.x(), azimuth = v.y(), elevation = v.z();
  return range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

}  // namespace

void E57BitStream::append(std::string_view bytes) {
  bytes_.erase(0, position_ / 8);
  position_ %= 8;
  bytes_.append(bytes);
}

std::uint64_t E57BitStream::take(int bits) {
  std::uint64_t value = 0;
  for (int done = 0; done < bits;) {
    const auto byte = static_cast<unsigned char>(bytes_[position_ / 8]);
    const int within = static_cast<int>(position_ % 8), part = std::min(8 - within, bits - done);
    value |= std::uint64_t{(static_cast<unsigned>(byte) >> within) & ((1U << part) - 1)} << done;
    done += part, position_ += static_cast<std::size_t>(part);
  }
  return value;
}

std::uint64_t E57Decoder::Channel::recordsLeft() const {
  return field.bits == 0 ? std::numeric_limits<std::uint64_t>::max()
                         : stream.bitsLeft() / static_cast<std::uint64_t>(field.bits);
}

double E57Decoder::Channel::take() {
  const std::uint64_t raw = stream.take(field.bits);
  if (field.type == E57Field::Type::Single) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  if (field.type == E57Field::Type::Double) return std::bit_cast<double>(raw);
  const auto value = static_cast<std::int64_t>(static_cast<std::uint64_t>(field.minimum) + raw);
  return static_cast<double>(value) * field.scale + field.offset;
}

E57Decoder::E57Decoder(const E57Scan& scan, const E57Selection& selection)
    : record_count_(scan.record_count), is_spherical_(selection.is_spherical) {
  for (const std::size_t field : selection.coordinates) addChannel(scan, field);
  has_invalid_ = selection.invalid.has_value();
  if (has_invalid_) addChannel(scan, *selection.invalid);
  has_cells_ = selection.row && selection.column;
  if (has_cells_) addChannel(scan, *selection.column), addChannel(scan, *selection.row);
}

void E57Decoder::addChannel(const E57Scan& scan, std::size_t field) {
  channels_.push_back({scan.fields[field], field, {}});
}

void E57Decoder::addPacket(std::string_view packet, const std::vector<std::size_t>& begins) {
  for (Channel& channel : channels_) {
    const std::size_t begin = begins[channel.number];
    channel.stream.append(packet.substr(begin, begins[channel.number + 1] - begin));
  }
  std::uint64_t complete = record_count_ - records_;
  for (const Channel& channel : channels_) complete = std::min(complete, channel.recordsLeft());
  for (std::uint64_t i = 0; i < complete; ++i) takeRecord();
  records_ += complete;
}

void E57Decoder::takeRecord() {
  Eigen::Vector3d values;
  for (int i = 0; i < 3; ++i) values[i] = channels_[static_cast<std::size_t>(i)].take();
  std::size_t next = 3;
  const bool is_valid = !has_invalid_ || channels_[next++].take() == 0;
  Cell cell;
  if (has_cells_) cell.column = index(channels_[next++].take()), cell.row = index(channels_[next].take());
  if (has_cells_) columns_.add(cell.column), rows_.add(cell.row);
  if (!is_valid) return;
  const Eigen::Vector3d scanned = is_spherical_ ? fromSpherical(values) : values;
  const Eigen::Vector3f point = scannedPoint({-scanned.y(), -scanned.z(), scanned.x()});
  if (!point.allFinite()) return;
  points_.push_back(point);
  if (has_cells_) cells_.push_back(cell);
}

// Indices that no image has make the scan a loose one.
int E57Decoder::index(double value) {
  constexpr double kLargest = 1 << 30;
  const bool is_index = std::abs(value) <= kLargest && value == std::floor(value);
  if (!is_index) has_wild_cells_ = true;
  return is_index ? static_cast<int>(value) : 0;
}

bool E57Decoder::isDense() const {
  constexpr std::int64_t kMostPixels = 1 << 26, kSparsest = 16;
  if (!has_cells_ || has_wild_cells_ || points_.empty()) return false;
  const std::int64_t columns = columns_.count(), rows = rows_.count();
  const auto records = static_cast<std::int64_t>(std::min<std::uint64_t>(records_, kMostPixels));
  return columns <= kMostPixels / rows && columns * rows <= kSparsest * records;
}

PointImage E57Decoder::image() const {
  PointImage image = noPoints(static_cast<int>(columns_.count()), static_cast<int>(rows_.count()));
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Eigen::Vector3f& pixel = image(cells_[i].column - columns_.low, cells_[i].row - rows_.low);
    // Of several returns of one pulse the nearest.
    if (!pixel.allFinite() || points_[i].squaredNorm() < pixel.squaredNorm()) pixel = points_[i];
  }
  return image;
}

PointScan E57Decoder::scan() {
  PointScan result;
  if (isDense())
    result.organised = upright(image());
  else
    result.loose = std::move(points_);
  return result;
}

}  // namespace vdbfuse
