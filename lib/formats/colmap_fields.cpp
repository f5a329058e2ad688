// SPDX-License-Identifier: Apache-2.0
#include "formats/colmap_fields.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "io/file_bytes.h"
#include "io/folder.h"
#include "io/text_cursor.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
static_assert(std::endian::native == std::endian::little);

class TextFields : public ColmapFields {
 public:
  explicit TextFields(const fs::path& path)
      : ColmapFields(path), text_(io::readFileBytes(path)), cursor_(this->path(), text_) {}

  bool next() override {
    first_ = cursor_.word();
    while (first_.starts_with('#')) {
      cursor_.restOfLine();
      first_ = cursor_.word();
    }
    return !first_.empty();
  }
  std::uint32_t id() override {
    const std::uint64_t value = longId();
    if (value > std::numeric_limits<std::uint32_t>::max()) cursor_.fail("a number below 2^32", word_);
    return static_cast<std::uint32_t>(value);
  }
  std::uint64_t longId() override {
    const std::optional<std::int64_t> value = io::parseInteger(word());
    if (!value || *value < 0) cursor_.fail("a whole number", word_);
    return static_cast<std::uint64_t>(*value);
  }
  double number() override {
    const double value = cursor_.numberOnLine();
    if (!std::isfinite(value)) cursor_.failWith("a finite number", numberText(value));
    return value;
  }
  bool flag() override { return id() != 0; }
  bool isCamera() override { return word() == "CAMERA"; }
  std::string model() override { return std::string(word()); }
  std::string name() override {
    std::string_view rest = cursor_.restOfLine();
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    return std::string(rest);
  }
  void skipPoints() override { cursor_.restOfLine(); }
  void skipColor() override {
    for (int i = 0; i < 4; ++i) word();
  }
  std::vector<std::uint32_t> track() override {
    std::vector<std::uint32_t> images;
    for (word_ = cursor_.wordOnLine(); !word_.empty(); word_ = cursor_.wordOnLine()) {
      first_ = word_;
      images.push_back(id());
      longId();  // which of its points
    }
    return images;
  }
  void fail(const std::string& expected, const std::string& found) const override {
    cursor_.failWith(expected, found);
  }

 private:
  // The first word of a record was read to see whether there is one.
  std::string_view word() {
    word_ = first_.empty() ? cursor_.wordOnLine() : std::exchange(first_, {});
    if (word_.empty()) cursor_.fail("another field", word_);
    return word_;
  }

  std::string text_;
  io::TextCursor cursor_;
  std::string_view first_, word_;
};

class BinaryFields : public ColmapFields {
 public:
  explicit BinaryFields(const fs::path& path) : ColmapFields(path), bytes_(io::readFileBytes(path)) {
    left_ = take<std::uint64_t>();
  }

  bool next() override {
    if (left_ == 0) return false;
    --left_;
    return true;
  }
  std::uint32_t id() override { return take<std::uint32_t>(); }
  std::uint64_t longId() override { return take<std::uint64_t>(); }
  double number() override {
    const auto value = take<double>();
    if (!std::isfinite(value)) fail("a finite number", numberText(value));
    return value;
  }
  bool flag() override { return take<std::uint8_t>() != 0; }
  bool isCamera() override { return take<std::int32_t>() == 0; }
  std::string model() override {
    constexpr std::array kNames = {"SIMPLE_PINHOLE",
                                   "PINHOLE",
                                   "SIMPLE_RADIAL",
                                   "RADIAL",
                                   "OPENCV",
                                   "OPENCV_FISHEYE",
                                   "FULL_OPENCV",
                                   "FOV",
                                   "SIMPLE_RADIAL_FISHEYE",
                                   "RADIAL_FISHEYE",
                                   "THIN_PRISM_FISHEYE"};
    const auto number = take<std::uint32_t>();
    return number < kNames.size() ? kNames[number] : "number " + std::to_string(number);
  }
  std::string name() override {
    const std::size_t end = bytes_.find('\0', position_);
    if (end == bytes_.npos) fail("the name of an image", "the end of the file");
    const std::string name = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return name;
  }
  void skipPoints() override {
    constexpr std::uint64_t kBytesOfAPoint = 24;
    position_ += static_cast<std::size_t>(countOf("points", kBytesOfAPoint) * kBytesOfAPoint);
  }
  void skipColor() override {
    for (int i = 0; i < 3; ++i) take<std::uint8_t>();
    take<double>();
  }
  std::vector<std::uint32_t> track() override {
    std::vector<std::uint32_t> images(static_cast<std::size_t>(countOf("observations", 8)));
    for (std::uint32_t& image : images) {
      image = take<std::uint32_t>();
      take<std::uint32_t>();  // which of its points
    }
    return images;
  }
  void fail(const std::string& expected, const std::string& found) const override {
    throw IoError(path(), "byte " + std::to_string(position_), expected, found);
  }

 private:
  // A number of things that must still be there.
  std::uint64_t countOf(const std::string& things, std::uint64_t bytes_of_one) {
    const auto count = take<std::uint64_t>();
    if (count > (bytes_.size() - position_) / bytes_of_one)
      fail(std::to_string(count) + " " + things + " of " + std::to_string(bytes_of_one) + " bytes",
           "the end of the file");
    return count;
  }
  template <class T>
  T take() {
    if (bytes_.size() - position_ < sizeof(T)) fail("another field", "the end of the file");
    T value;
    std::memcpy(&value, bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }

  std::string bytes_;
  std::size_t position_ = 0;
  std::uint64_t left_ = 0;
};

}  // namespace

std::unique_ptr<ColmapFields> openColmapFile(const fs::path& folder, const std::string& stem) {
  if (isFile(folder / (stem + ".bin"))) return std::make_unique<BinaryFields>(folder / (stem + ".bin"));
  if (isFile(folder / (stem + ".txt"))) return std::make_unique<TextFields>(folder / (stem + ".txt"));
  return nullptr;
}

}  // namespace vdbfuse
