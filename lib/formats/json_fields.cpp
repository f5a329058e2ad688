// SPDX-License-Identifier: Apache-2.0
#include "formats/json_fields.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/file_bytes.h"
#include "io/text_lines.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {

struct JsonField::File {
  std::filesystem::path path;
  nlohmann::json root;
};

JsonField JsonField::readFile(const std::filesystem::path& path) {
  constexpr std::uint64_t kLargest = 32 << 20;
  if (io::fileSize(path) > kLargest) throw IoError(path, "", "a JSON file of up to 32 MB", "a larger one");
  const std::string text = io::readFileBytes(path);
  auto file = std::make_shared<File>();
  file->path = path;
  try {
    file->root = nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw IoError(path, "line " + std::to_string(1 + std::count(text.begin(), end, '\n')), "JSON",
                  error.byte >= text.size() ? "the end of the file" : "something else");
  } catch (const nlohmann::json::exception&) {
    throw IoError(path, "", "JSON", "a number that is too large");
  }
  const nlohmann::json* root = &file->root;
  return {std::move(file), root, ""};
}

std::optional<JsonField> JsonField::find(const std::string& key) const {
  if (!value_->is_object()) return std::nullopt;
  const auto found = value_->find(key);
  if (found == value_->end() || found->is_null()) return std::nullopt;
  return JsonField(file_, &*found, place_.empty() ? key : place_ + "." + key);
}

JsonField JsonField::at(const std::string& key) const {
  std::optional<JsonField> found = find(key);
  if (!found) fail("a field '" + key + "'", value_->is_object() ? "none" : kind());
  return *found;
}

std::size_t JsonField::size() const {
  if (!value_->is_array()) fail("an array", kind());
  return value_->size();
}

JsonField JsonField::operator[](std::size_t index) const {
  return {file_, &(*value_)[index], place_ + "[" + std::to_string(index) + "]"};
}

double JsonField::number() const {
  if (!value_->is_number()) fail("a number", kind());
  const auto value = value_->get<double>();
  if (!std::isfinite(value)) fail("a finite number", numberText(value));
  return value;
}

int JsonField::whole(int least, int most) const {
  const double value = number();
  if (!(value >= least && value <= most && value == std::floor(value)))
    fail("a whole number from " + std::to_string(least) + " to " + std::to_string(most), numberText(value));
  return static_cast<int>(value);
}

bool JsonField::truth() const {
  if (!value_->is_boolean()) fail("true or false", kind());
  return value_->get<bool>();
}

std::string JsonField::text() const {
  if (!value_->is_string()) fail("a text", kind());
  return value_->get<std::string>();
}

Eigen::MatrixXd JsonField::rows() const {
  const std::size_t count = size();
  if (count != 3 && count != 4) fail("a matrix of 3 or 4 rows", std::to_string(count));
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(count), 4);
  for (std::size_t row = 0; row < count; ++row)
    matrix.row(static_cast<Eigen::Index>(row)) = (*this)[row].numbers(4).transpose();
  return matrix;
}

Eigen::VectorXd JsonField::numbers(std::size_t count) const {
  if (size() != count) fail(std::to_string(count) + " numbers", std::to_string(size()));
  Eigen::VectorXd result(static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) result[static_cast<Eigen::Index>(i)] = (*this)[i].number();
  return result;
}

void JsonField::fail(const std::string& expected, const std::string& found) const {
  throw IoError(file_->path, place_, expected, found);
}

std::string JsonField::kind() const {
  const std::string name = value_->type_name();
  return name == "array" || name == "object" ? "an " + name : name == "null" ? name : "a " + name;
}

}  // namespace vdbfuse
