// SPDX-License-Identifier: Apache-2.0
#include "json_file.h"

#include <filesystem>

#include "text_file.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/version.h"

namespace vdbfuse::tool {

Json jsonOf(const char* command) {
  Json json;
  json["version"] = VDBFUSE_VERSION;
  json["command"] = command;
  return json;
}

Json stepsJson(const std::vector<StepTime>& steps) {
  Json list = Json::array();
  for (const StepTime& s : steps)
    list.push_back({{"name", s.name}, {"seconds", s.seconds}, {"cpu_seconds", s.cpu_seconds}});
  return list;
}

std::string jsonText(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

void writeJson(const std::filesystem::path& path, const Json& json) {
  replaceText(path, jsonText(json) + "\n");
}

void refuseExisting(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) throw IoError(path, "exists already; give --overwrite to replace it");
}

}  // namespace vdbfuse::tool
