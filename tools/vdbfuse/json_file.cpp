// SPDX-License-Identifier: Apache-2.0
#include "json_file.h"

#include <cerrno>
#include <fstream>
#include <system_error>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::tool {

Json jsonOf(const char* command) {
  Json json;
  json["version"] = VDBFUSE_VERSION;
  json["command"] = command;
  return json;
}

std::string jsonText(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace); }

void writeJson(const std::filesystem::path& path, const Json& json) {
  AtomicFile target(path);
  std::ofstream file(target.temporaryPath(), std::ios::binary);
  file << jsonText(json) << '\n';
  file.close();
  if (!file) throw IoError(path, "cannot be written: " + std::generic_category().message(errno));
  target.commit();
}

void refuseExisting(const std::filesystem::path& path) {
  if (std::filesystem::exists(path)) throw IoError(path, "exists already; give --overwrite to replace it");
}

}  // namespace vdbfuse::tool
