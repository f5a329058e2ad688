// SPDX-License-Identifier: Apache-2.0
#include "memory_option.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "run_options.h"

namespace vdbfuse::tool {
namespace {

std::optional<double> parseSize(const std::string& text) {
  static const std::map<std::string, double> units = {
      {"", 1.0},     {"B", 1.0},      {"kB", 1e3},     {"MB", 1e6},    {"GB", 1e9},
      {"TB", 1e12},  {"K", 0x1p10},   {"KiB", 0x1p10}, {"M", 0x1p20},  {"MiB", 0x1p20},
      {"G", 0x1p30}, {"GiB", 0x1p30}, {"T", 0x1p40},   {"TiB", 0x1p40}};
  double number = 0;
  int used = 0;
  if (std::sscanf(text.c_str(), "%lf %n", &number, &used) != 1) return std::nullopt;
  const auto unit = units.find(text.substr(static_cast<std::size_t>(used)));
  if (unit == units.end()) return std::nullopt;
  const double bytes = number * unit->second;
  return bytes >= 1 && bytes < 0x1p62 ? std::optional(bytes) : std::nullopt;
}

}  // namespace

CLI::Option* addMemoryOption(CLI::App& app, std::size_t& bytes) {
  return app
      .add_option_function<std::string>(
          "--memory",
          [&bytes](const std::string& text) { bytes = static_cast<std::size_t>(*parseSize(text)); },
          "Memory that may be used. Views that do not fit lie in a file in $TMPDIR or /var/tmp")
      ->check([](const std::string& text) {
        return parseSize(text) ? std::string() : "expected a size like 8GiB, found '" + text + "'";
      })
      ->type_name("SIZE")
      ->option_text("80 % of what is free")
      ->group(kRunGroup);
}

}  // namespace vdbfuse::tool
