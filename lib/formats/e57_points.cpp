// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "formats/scan_grid.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using io::littleEndian;

constexpr std::size_t kSectionHeader = 32, kPacketHeader = 4, kDataHeader = 6;

// The part of a bytestream that has been read from packets and not taken yet.
class BitStream {
 public:
  void append(std::string_view bytes) {
    bytes_.erase(0, position_ / 8);
    position_ %= 8;
    bytes_.append(bytes);
  }
  std::uint64_t bitsLeft() const { return bytes_.size() * 8 - position_; }

  // REQUIRES: bits <= bitsLeft(), bits <= 64.
  std::uint64_t take(int bits) {
    std::uint64_t value = 0;
    for (int done = 0; done < bits;) {
      const auto byte = static_cast<unsigned char>(bytes_[position_ / 8]);
      const int within = static_cast<int>(position_ % 8), part = std::min(8 - within, bits - done);
      value |= std::uint64_t{(static_cast<unsigned>(byte) >> within) & ((1U << part) - 1)} << done;
      done += part, position_ += static_cast<std::size_t>(part);
    }
    return value;
  }

 private:
  std::string bytes_;
  std::size_t position_ = 0;  // bits
};

// A field with its bytestream.
struct Channel {
  E57Field field;
  std::size_t number = 0;
  BitStream stream;

  std::uint64_t recordsLeft() const {
    return field.bits == 0 ? std::numeric_limits<std::uint64_t>::max()
                           : stream.bitsLeft() / static_cast<std::uint64_t>(field.bits);
  }
  double take() {
    const std::uint64_t raw = stream.take(field.bits);
    if (field.type == E57Field::Type::Single) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
    if (field.type == E57Field::Type::Double) return std::bit_cast<double>(raw);
    const auto value = static_cast<std::int64_t>(static_cast<std::uint64_t>(field.minimum) + raw);
    return static_cast<double>(value) * field.scale + field.offset;
  }
};

Eigen::Vector3d fromSpherical(const Eigen::Vector3d& v) {
  const double range = v.x(), azimuth = v.y(), elevation = v.z();
  return range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

struct Cell {
  int column = 0, row = 0;
};

// Extent of rows and columns.
struct Cells {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  void add(int i) { low = std::min(low, i), high = std::max(high, i); }
  std::int64_t count() const { return std::int64_t{high} - low + 1; }
};

class Decoder {
 public:
  Decoder(const E57Scan& scan, const E57Selection& selection)
      : record_count_(scan.record_count), is_spherical_(selection.is_spherical) {
    for (const std::size_t field : selection.coordinates) addChannel(scan, field);
    has_invalid_ = selection.invalid.has_value();
    if (has_invalid_) addChannel(scan, *selection.invalid);
    has_cells_ = selection.row && selection.column;
    if (has_cells_) addChannel(scan, *selection.column), addChannel(scan, *selection.row);
  }

  bool isDone() const { return records_ == record_count_; }
  std::uint64_t records() const { return records_; }

  // `begins` are where bytestreams lie in the packet, one more than there are.
  void addPacket(std::string_view packet, const std::vector<std::size_t>& begins) {
    for (Channel& channel : channels_) {
      const std::size_t begin = begins[channel.number];
      channel.stream.append(packet.substr(begin, begins[channel.number + 1] - begin));
    }
    std::uint64_t complete = record_count_ - records_;
    for (const Channel& channel : channels_) complete = std::min(complete, channel.recordsLeft());
    for (std::uint64_t i = 0; i < complete; ++i) takeRecord();
    records_ += complete;
  }

  PointScan scan() {
    PointScan result;
    if (!has_cells_ || points_.empty() || !isDense()) {
      result.loose = std::move(points_);
      return result;
    }
    PointImage image = noPoints(static_cast<int>(columns_.count()), static_cast<int>(rows_.count()));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Eigen::Vector3f& pixel = image(cells_[i].column - columns_.low, cells_[i].row - rows_.low);
      // Of several returns of one pulse the nearest.
      if (!pixel.allFinite() || points_[i].squaredNorm() < pixel.squaredNorm()) pixel = points_[i];
    }
    result.organised = upright(std::move(image));
    return result;
  }

 private:
  void addChannel(const E57Scan& scan, std::size_t field) {
    channels_.push_back({scan.fields[field], field, {}});
  }

  void takeRecord() {
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
  int index(double value) {
    constexpr double kLargest = 1 << 30;
    const bool is_index = std::abs(value) <= kLargest && value == std::floor(value);
    if (!is_index) has_wild_cells_ = true;
    return is_index ? static_cast<int>(value) : 0;
  }

  bool isDense() const {
    constexpr std::int64_t kMostPixels = 1 << 26, kSparsest = 64;
    const std::int64_t columns = columns_.count(), rows = rows_.count();
    const auto records = static_cast<std::int64_t>(std::min<std::uint64_t>(records_, kMostPixels));
    return !has_wild_cells_ && columns <= kMostPixels / rows && columns * rows <= kSparsest * records;
  }

  std::uint64_t record_count_, records_ = 0;
  bool is_spherical_, has_invalid_ = false, has_cells_ = false, has_wild_cells_ = false;
  std::vector<Channel> channels_;  // coordinates, then the others that are there
  std::vector<Eigen::Vector3f> points_;
  std::vector<Cell> cells_;
  Cells columns_, rows_;
};

// Walks through the packets of a section.
class SectionReader {
 public:
  SectionReader(const fs::path& path, const E57Scan& scan) : path_(path), scan_(scan), pages_(path) {
    const std::uint64_t start = pages_.logical(scan.section, "the points of " + scan.place);
    const std::string header = pages_.read(start, kSectionHeader, "a section header");
    if (header[0] != 1)
      throw IoError(path, pages_.place(start), "a section of points (1)",
                    "kind " + std::to_string(static_cast<unsigned char>(header[0])));
    const std::uint64_t length = littleEndian(header, 8, 8);
    if (length > pages_.logicalSize() - start)
      throw IoError(path, pages_.place(start + 8), "a section that ends in the file",
                    std::to_string(length) + " bytes");
    end_ = start + length;
    position_ = pages_.logical(littleEndian(header, 16, 8), "the first packet of " + scan.place);
  }

  void decode(Decoder& decoder) {
    while (!decoder.isDone()) {
      if (position_ >= end_)
        throw IoError(path_, pages_.place(position_),
                      std::to_string(scan_.record_count) + " records of " + scan_.place,
                      std::to_string(decoder.records()));
      readPacket(decoder);
    }
  }

 private:
  void readPacket(Decoder& decoder) {
    const std::string header = pages_.read(position_, kPacketHeader, "a packet header");
    const auto kind = static_cast<unsigned char>(header[0]);
    const std::uint64_t length = littleEndian(header, 2, 2) + 1;
    if (kind > 2) fail("a packet of kind 0, 1 or 2", "kind " + std::to_string(kind));
    if (length % 4 != 0) fail("a packet of a multiple of 4 bytes", std::to_string(length) + " bytes");
    if (kind == 1) {
      const std::string packet = pages_.read(position_, length, "a packet");
      decoder.addPacket(packet, bytestreams(packet));
    }
    position_ += length;
  }

  std::vector<std::size_t> bytestreams(const std::string& packet) const {
    const std::size_t streams = scan_.fields.size();
    std::vector<std::size_t> begins = {kDataHeader + 2 * streams};
    if (begins.front() > packet.size() || littleEndian(packet, 4, 2) != streams)
      fail(std::to_string(streams) + " bytestreams", "another number");
    for (std::size_t i = 0; i < streams; ++i)
      begins.push_back(begins.back() + littleEndian(packet, kDataHeader + 2 * i, 2));
    if (begins.back() > packet.size())
      fail("bytestreams inside their packet", std::to_string(begins.back()) + " bytes");
    return begins;
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw IoError(path_, pages_.place(position_), expected, found);
  }

  const fs::path& path_;
  const E57Scan& scan_;
  io::E57Pages pages_;
  std::uint64_t position_ = 0, end_ = 0;
};

}  // namespace

E57Selection selectFields(const fs::path& path, const E57Scan& scan) {
  static constexpr const char* kCartesian[] = {"cartesianX", "cartesianY", "cartesianZ"};
  static constexpr const char* kSpherical[] = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
  E57Selection selection;
  selection.is_spherical =
      !(scan.find(kCartesian[0]) && scan.find(kCartesian[1]) && scan.find(kCartesian[2]));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto field = scan.find(selection.is_spherical ? kSpherical[i] : kCartesian[i]);
    if (!field || scan.fields[*field].type == E57Field::Type::Other)
      throw IoError(path, scan.place + "/points/prototype",
                    "numbers cartesianX, Y, Z or sphericalRange, Azimuth, Elevation",
                    std::string(field ? "no number " : "no ") +
                        (selection.is_spherical ? kSpherical[i] : kCartesian[i]));
    selection.coordinates[i] = *field;
  }
  const auto integer = [&](const char* name) {
    const auto field = scan.find(name);
    const bool is_integer = field && scan.fields[*field].type == E57Field::Type::Integer;
    return is_integer ? field : std::nullopt;
  };
  selection.invalid = integer(selection.is_spherical ? "sphericalInvalidState" : "cartesianInvalidState");
  selection.row = integer("rowIndex"), selection.column = integer("columnIndex");
  return selection;
}

PointScan readE57Points(const fs::path& path, const E57Scan& scan) {
  Decoder decoder(scan, selectFields(path, scan));
  SectionReader(path, scan).decode(decoder);
  return decoder.scan();
}

}  // namespace vdbfuse
