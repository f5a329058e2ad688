// SPDX-License-Identifier: Apache-2.0
#include "formats/pcd_header.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

constexpr std::size_t kLongestHeader = 64 * 1024;

// Reads the lines of a header one by one; each method reads the rest of a line whose key has been taken.
class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, std::string_view text) : path_(path), cursor_(path, text) {}

  PcdLayout readAny() {
    readLines();
    for (const char* name : {"x", "y", "z"}) requireFloat(name, AnyFloat::Yes);
    requirePoints();
    return layout_;
  }

  PcdHeader readOrganised() {
    readLines();
    for (const char* name : {"x", "y", "z"}) requireFloat(name, AnyFloat::No);
    if (std::min(layout_.width, layout_.height) < 2 ||
        std::max(layout_.width, layout_.height) > kLargestSide) {
      cursor_.failWith("an organised cloud (WIDTH and HEIGHT above 1)",
                       std::to_string(layout_.width) + "x" + std::to_string(layout_.height));
    }
    requirePoints();
    requireData();
    return {static_cast<int>(layout_.width), static_cast<int>(layout_.height), layout_.viewpoint};
  }

 private:
  void readLines() {
    while (layout_.data.empty()) readLine();
    if (layout_.fields.empty()) cursor_.failWith("FIELDS before DATA", "none");
    layout_.points = pixels();
    layout_.data_begin = cursor_.position();
  }

  void readLine() {
    const std::string_view key = cursor_.word();
    if (key.empty()) cursor_.fail("DATA", key);
    if (key == "FIELDS") return readFields();
    if (key == "SIZE") return readEach([](PcdField& f, std::int64_t v) { f.size = v; });
    if (key == "COUNT") return readEach([](PcdField& f, std::int64_t v) { f.count = v; });
    if (key == "TYPE") return readTypes();
    if (key == "WIDTH") return void(layout_.width = integer(kMostPoints));
    if (key == "HEIGHT") return void(layout_.height = integer(kMostPoints));
    if (key == "POINTS") return void(points_ = integer(std::numeric_limits<std::int64_t>::max()));
    if (key == "VIEWPOINT") return readViewpoint();
    if (key == "DATA") return readData();
    if (!key.starts_with('#') && key != "VERSION") cursor_.fail("a line of a PCD header", key);
    cursor_.restOfLine();
  }

  void readFields() {
    layout_.fields.clear();
    for (std::string_view name = cursor_.wordOnLine(); !name.empty(); name = cursor_.wordOnLine())
      layout_.fields.push_back({std::string(name), 0, 1, {}});
  }

  template <class Set>
  void readEach(const Set& set) {
    for (PcdField& field : layout_.fields) set(field, integer(kLargestSide));
  }

  void readTypes() {
    for (PcdField& field : layout_.fields) {
      const std::string_view type = cursor_.wordOnLine();
      if (type != "F" && type != "I" && type != "U") cursor_.fail("F, I or U", type);
      field.type = type;
    }
  }

  std::int64_t integer(std::int64_t largest) {
    const std::string_view word = cursor_.wordOnLine();
    const auto value = parseInteger(word);
    if (!value || *value < 0 || *value > largest) cursor_.fail("a whole number", word);
    return *value;
  }

  void readViewpoint() {
    double v[7];
    for (double& number : v) number = cursor_.numberOnLine();
    const Eigen::Quaterniond turn(v[3], v[4], v[5], v[6]);
    const Eigen::Vector3d origin(v[0], v[1], v[2]);
    constexpr double kTolerance = 1e-3;
    if (!origin.allFinite() || !(std::abs(turn.norm() - 1) < kTolerance))
      cursor_.failWith("VIEWPOINT tx ty tz qw qx qy qz with a quaternion of length 1",
                       "length " + std::to_string(turn.norm()));
    layout_.viewpoint.linear() = turn.normalized().toRotationMatrix();
    layout_.viewpoint.translation() = origin;
  }

  void readData() {
    const std::string_view data = cursor_.wordOnLine();
    if (data != "ascii" && data != "binary" && data != "binary_compressed")
      cursor_.fail("DATA ascii, binary or binary_compressed", data);
    layout_.data = data;
    cursor_.restOfLine();
  }

  enum class AnyFloat { Yes, No };  // or only of four bytes
  void requireFloat(const std::string& name, AnyFloat any) {
    for (const PcdField& field : layout_.fields) {
      if (field.name != name) continue;
      if (field.type == "F" && field.size == 4 && field.count == 1) return;
      if (field.type == "F" && field.size == 8 && field.count == 1 && any == AnyFloat::Yes) return;
      cursor_.failWith("the field " + name + " as one 4-byte float (SIZE 4, TYPE F)",
                       "SIZE " + std::to_string(field.size) + ", TYPE " + field.type);
    }
    cursor_.failWith("the field " + name, "none of that name");
  }

  void requirePoints() const {
    if (points_ && *points_ != pixels())
      cursor_.failWith("POINTS " + std::to_string(pixels()) + " (WIDTH x HEIGHT)", std::to_string(*points_));
  }

  // Only where the length follows from the header.
  void requireData() const {
    if (layout_.data != "binary") return;
    std::uint64_t point = 0;
    for (const PcdField& field : layout_.fields)
      point += static_cast<std::uint64_t>(field.size * field.count);
    const std::uint64_t wanted = cursor_.position() + point * static_cast<std::uint64_t>(pixels());
    const std::uint64_t found = fileSize(path_);
    if (found < wanted)
      throw IoError(path_, "byte " + std::to_string(found), std::to_string(wanted) + " bytes",
                    "the end of the file");
  }

  std::int64_t pixels() const { return layout_.width * layout_.height; }

  static constexpr std::int64_t kLargestSide = 65535, kMostPoints = std::numeric_limits<std::int32_t>::max();
  const std::filesystem::path& path_;
  TextCursor cursor_;
  PcdLayout layout_;
  std::optional<std::int64_t> points_;
};

}  // namespace

PcdLayout parsePcdLayout(const std::filesystem::path& path, std::string_view bytes) {
  return HeaderReader(path, bytes).readAny();
}

PcdHeader readPcdHeader(const std::filesystem::path& path) {
  const std::string start = readFileStart(path, kLongestHeader);
  return HeaderReader(path, start).readOrganised();
}

}  // namespace vdbfuse::io
