// SPDX-License-Identifier: Apache-2.0
// Records of E57 points out of their bytestreams.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/e57_scan.h"
#include "formats/point_views.h"

namespace vdbfuse {

/// Which of a scan's fields are read.
struct E57Selection {
  std::size_t coordinates[3] = {};
  bool is_spherical = false;
  std::optional<std::size_t> invalid, row, column;
};

/// The part of a bytestream that has been read from packets and not taken yet.
class E57BitStream {
 public:
  void append(std::string_view bytes);
  std::uint64_t bitsLeft() const { return bytes_.size() * 8 - position_; }
  /// REQUIRES: bits <= bitsLeft(), bits <= 64.
  std::uint64_t take(int bits);

 private:
  std::string bytes_;
  std::size_t position_ = 0;  // bits
};

/// Takes packets and gives points.
class E57Decoder {
 public:
  E57Decoder(const E57Scan& scan, const E57Selection& selection);

  bool isDone() const { return records_ == record_count_; }
  std::uint64_t records() const { return records_; }
  /// `begins` are where bytestreams lie in the packet, one more than there are.
  void addPacket(std::string_view packet, const std::vector<std::size_t>& begins);
  /// All valid points so far, in camera axes (readE57Points()). Call it once.
  PointScan scan();

 private:
  // A field with its bytestream.
  struct Channel {
    E57Field field;
    std::size_t number = 0;
    E57BitStream stream;

    std::uint64_t recordsLeft() const;
    double take();
  };
  struct Cell {
    int column = 0, row = 0;
  };
  // Extent of rows or columns.
  struct Extent {
    int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
    void add(int i) { low = std::min(low, i), high = std::max(high, i); }
    std::int64_t count() const { return std::int64_t{high} - low + 1; }
  };

  void addChannel(const E57Scan& scan, std::size_t field);
  void takeRecord();
  int index(double value);
  bool isDense() const;
  PointImage image() const;

  std::uint64_t record_count_, records_ = 0;
  bool is_spherical_, has_invalid_ = false, has_cells_ = false, has_wild_cells_ = false;
  std::vector<Channel> channels_;  // coordinates, then the others that are there
  std::vector<Eigen::Vector3f> points_;
  std::vector<Cell> cells_;
  Extent columns_, rows_;
};

}  // namespace vdbfuse
