// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vdbfuse/base/progress.h"

namespace vdbfuse::tool {

/// Members stay in the order in which they are set.
using Json = nlohmann::ordered_json;

/// An object that begins with the version of the tool and the name of the subcommand.
Json jsonOf(const char* command);

/// Name, wall and processor time of each step.
Json stepsJson(const std::vector<StepTime>& steps);

/// Two spaces an indent. Numbers that are not finite become null.
std::string jsonText(const Json& json);

/// Writes the object; the file is complete or absent. Numbers that are not finite become null. Throws
/// IoError.
void writeJson(const std::filesystem::path& path, const Json& json);

/// Throws IoError when `path` is there already: without --overwrite an existing output is an error. Ask
/// before the work, not after it.
void refuseExisting(const std::filesystem::path& path);

}  // namespace vdbfuse::tool
