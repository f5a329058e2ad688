// SPDX-License-Identifier: Apache-2.0
#include "formats/json_file.h"

#include <cmath>

#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;
constexpr int kDeepest = 64;

std::string placed(const std::string& place, const std::string& key) {
  return place.empty() ? key : place + " " + key;
}

std::string kindText(const Json& value) {
  if (value.is_number()) return "a number that is not finite";
  return std::string(value.is_array() ? "an " : "a ") + value.type_name();
}

double numberOf(const std::filesystem::path& path, const std::string& place, const Json& value) {
  if (value.is_number() && std::isfinite(value.get<double>())) return value.get<double>();
  throw IoError(path, place, "a finite number", kindText(value));
}

}  // namespace

Json readJsonFile(const std::filesystem::path& path) {
  const std::uint64_t size = io::fileSize(path);
  if (size > kMostBytes)
    throw IoError(path, "", "a JSON file of at most " + std::to_string(kMostBytes) + " bytes",
                  std::to_string(size) + " bytes");
  // Too deep a nesting would exhaust the stack when the values are taken down again.
  bool too_deep = false;
  const auto limit = [&](int depth, Json::parse_event_t, Json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  try {
    Json json = Json::parse(io::readFileBytes(path), limit);
    if (too_deep) throw IoError(path, "", "JSON of at most 64 levels", "more");
    return json;
  } catch (const Json::parse_error& error) {
    throw IoError(path, "byte " + std::to_string(error.byte), "JSON", "something else");
  } catch (const Json::exception&) {
    throw IoError(path, "", "JSON", "a number or a text that is none");
  }
}

std::optional<double> jsonNumber(const std::filesystem::path& path, const std::string& place,
                                 const Json& object, const std::string& key) {
  if (!object.is_object()) throw IoError(path, place, "an object", kindText(object));
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return std::nullopt;
  return numberOf(path, placed(place, key), *found);
}

double requireJsonNumber(const std::filesystem::path& path, const std::string& place, const Json& object,
                         const std::string& key) {
  const auto value = jsonNumber(path, place, object, key);
  if (!value) throw IoError(path, placed(place, key), "a finite number", "none");
  return *value;
}

std::string jsonText(const std::filesystem::path& path, const std::string& place, const Json& object,
                     const std::string& key) {
  if (!object.is_object()) throw IoError(path, place, "an object", kindText(object));
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return {};
  if (!found->is_string()) throw IoError(path, placed(place, key), "a text", kindText(*found));
  return found->get<std::string>();
}

Eigen::MatrixXd jsonMatrix(const std::filesystem::path& path, const std::string& place, const Json& object,
                           const std::string& key, int rows, int columns) {
  if (!object.is_object()) throw IoError(path, place, "an object", kindText(object));
  const auto found = object.find(key);
  const std::string here = placed(place, key);
  const std::string expected =
      "a matrix of " + std::to_string(rows) + "x" + std::to_string(columns) + " numbers";
  if (found == object.end()) throw IoError(path, here, expected, "none");
  if (!found->is_array()) throw IoError(path, here, expected, kindText(*found));
  std::vector<double> numbers;
  for (const Json& row : *found) {
    if (!row.is_array()) {
      numbers.push_back(numberOf(path, here, row));
      continue;
    }
    for (const Json& value : row) numbers.push_back(numberOf(path, here, value));
  }
  if (numbers.size() != static_cast<std::size_t>(rows * columns))
    throw IoError(path, here, expected, std::to_string(numbers.size()) + " numbers");
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      numbers.data(), rows, columns);
}

}  // namespace vdbfuse
