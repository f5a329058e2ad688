// SPDX-License-Identifier: Apache-2.0
// JSON files of others: read whole, every access checked, every complaint an IoError that names the key.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace vdbfuse {

using Json = nlohmann::json;

/// Throws IoError: not JSON (with the byte), deeper than 64 levels, or larger than 256 MiB.
Json readJsonFile(const std::filesystem::path& path);

/// The member `key` of an object as a finite number; nothing when it is absent. `place` names the object in
/// errors. Throws IoError.
std::optional<double> jsonNumber(const std::filesystem::path& path, const std::string& place,
                                 const Json& object, const std::string& key);

/// The same, which must be there.
double requireJsonNumber(const std::filesystem::path& path, const std::string& place, const Json& object,
                         const std::string& key);

/// The member as a text; empty when it is absent. Throws IoError.
std::string jsonText(const std::filesystem::path& path, const std::string& place, const Json& object,
                     const std::string& key);

/// The member as a matrix: an array of rows, or all numbers in one array row by row. Throws IoError.
Eigen::MatrixXd jsonMatrix(const std::filesystem::path& path, const std::string& place, const Json& object,
                           const std::string& key, int rows, int columns);

}  // namespace vdbfuse
