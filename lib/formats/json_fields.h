// SPDX-License-Identifier: Apache-2.0
// JSON files of cameras: every field that is missing or of another kind is an IoError that names its place.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace vdbfuse {

/// A value in a JSON file. Keeps the file's text alive; copies are cheap.
class JsonField {
 public:
  /// The whole of a file of up to 32 MB. Throws IoError.
  static JsonField readFile(const std::filesystem::path& path);

  const std::string& place() const { return place_; }  ///< "frames[3].w"; empty: the file

  /// The member of that name; none when there is none, when it is null, or when this is no object.
  std::optional<JsonField> find(const std::string& key) const;
  /// The same; throws IoError when there is none.
  JsonField at(const std::string& key) const;
  /// Elements of an array. Throws IoError when it is none.
  std::size_t size() const;
  /// REQUIRES: index < size().
  JsonField operator[](std::size_t index) const;

  /// Throw IoError when the value is of another kind.
  double number() const;                 ///< finite
  int whole(int least, int most) const;  ///< a whole number in [least, most]
  bool truth() const;
  std::string text() const;
  Eigen::MatrixXd rows() const;                      ///< an array of 3 or 4 arrays of 4 numbers
  Eigen::VectorXd numbers(std::size_t count) const;  ///< an array of as many numbers

  /// Throws an IoError at this place.
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;

 private:
  struct File;
  JsonField(std::shared_ptr<const File> file, const nlohmann::json* value, std::string place)
      : file_(std::move(file)), value_(value), place_(std::move(place)) {}
  std::string kind() const;

  std::shared_ptr<const File> file_;
  const nlohmann::json* value_;
  std::string place_;
};

}  // namespace vdbfuse
