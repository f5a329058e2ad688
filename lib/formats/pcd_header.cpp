// SPDX-License-Identifier: Apache-2.0
#include "formats/pcd_header.h"

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

struct Field {
  std::string name;
  std::int64_t size = 0, count = 1;
  std::string type;
};

// Reads the lines of a header one by one; each method reads the rest of a line whose key has been taken.
class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& path, std::string_view text) : path_(path), cursor_(path, text) {}

  PcdHeader read() {
    while (data_.empty()) readLine();
    if (fields_.empty()) cursor_.failWith("FIELDS before DATA", "none");
    for (const char* name : {"x", "y", "z"}) requireFloat(name);
    if (header_.width < 2 || header_.height < 2) {
      cursor_.failWith("an organised cloud (WIDTH and HEIGHT above 1)",
                       std::to_string(header_.width) + "x" + std::to_string(header_.height));
    }
    if (points_ && *points_ != pixels()) {
      cursor_.failWith("POINTS " + std::to_string(pixels()) + " (WIDTH x HEIGHT)", std::to_string(*points_));
    }
    requireData();
    return header_;
  }

 private:
  void readLine() {
    const std::string_view key = cursor_.word();
    if (key.empty()) cursor_.fail("DATA", key);
    if (key == "FIELDS") return readFields();
    if (key == "SIZE") return readEach([](Field& f, std::int64_t v) { f.size = v; });
    if (key == "COUNT") return readEach([](Field& f, std::int64_t v) { f.count = v; });
    if (key == "TYPE") return readTypes();
    if (key == "WIDTH") return void(header_.width = static_cast<int>(integer(kLargestSide)));
    if (key == "HEIGHT") return void(header_.height = static_cast<int>(integer(kLargestSide)));
    if (key == "POINTS") return void(points_ = integer(std::numeric_limits<std::int64_t>::max()));
    if (key == "VIEWPOINT") return readViewpoint();
    if (key == "DATA") return readData();
    if (!key.starts_with('#') && key != "VERSION") cursor_.fail("a line of a PCD header", key);
    cursor_.restOfLine();
  }

  void readFields() {
    fields_.clear();
    for (std::string_view name = cursor_.wordOnLine(); !name.empty(); name = cursor_.wordOnLine())
      fields_.push_back({std::string(name), 0, 1, {}});
  }

  template <class Set>
  void readEach(const Set& set) {
    for (Field& field : fields_) set(field, integer(kLargestSide));
  }

  void readTypes() {
    for (Field& field : fields_) {
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
    header_.viewpoint.linear() = turn.normalized().toRotationMatrix();
    header_.viewpoint.translation() = origin;
  }

  void readData() {
    const std::string_view data = cursor_.wordOnLine();
    if (data != "ascii" && data != "binary" && data != "binary_compressed")
      cursor_.fail("DATA ascii, binary or binary_compressed", data);
    data_ = data;
    cursor_.restOfLine();
  }

  void requireFloat(const std::string& name) {
    for (const Field& field : fields_) {
      if (field.name != name) continue;
      if (field.type == "F" && field.size == 4 && field.count == 1) return;
      cursor_.failWith("the field " + name + " as one 4-byte float (SIZE 4, TYPE F)",
                       "SIZE " + std::to_string(field.size) + ", TYPE " + field.type);
    }
    cursor_.failWith("the field " + name, "none of that name");
  }

  // Only where the length follows from the header.
  void requireData() const {
    if (data_ != "binary") return;
    std::uint64_t point = 0;
    for (const Field& field : fields_) point += static_cast<std::uint64_t>(field.size * field.count);
    const std::uint64_t wanted = cursor_.position() + point * static_cast<std::uint64_t>(pixels());
    const std::uint64_t found = fileSize(path_);
    if (found < wanted)
      throw IoError(path_, "byte " + std::to_string(found), std::to_string(wanted) + " bytes",
                    "the end of the file");
  }

  std::int64_t pixels() const { return std::int64_t{header_.width} * header_.height; }

  static constexpr std::int64_t kLargestSide = 65535;
  const std::filesystem::path& path_;
  TextCursor cursor_;
  PcdHeader header_;
  std::vector<Field> fields_;
  std::optional<std::int64_t> points_;
  std::string data_;
};

}  // namespace

PcdHeader readPcdHeader(const std::filesystem::path& path) {
  const std::string start = readFileStart(path, kLongestHeader);
  return HeaderReader(path, start).read();
}

}  // namespace vdbfuse::io
