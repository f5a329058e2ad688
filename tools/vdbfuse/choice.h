// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace vdbfuse::tool {

/// An option that takes one of `names`.
template <class T>
CLI::Option* choice(CLI::App& app, const std::string& name, T& target, const std::map<std::string, T>& names,
                    const std::string& help) {
  std::string allowed;
  for (const auto& [word, value] : names) allowed += (allowed.empty() ? "" : "|") + word;
  return app.add_option(name, target, help)
      ->transform(CLI::CheckedTransformer(names, CLI::ignore_case).description(""))
      ->option_text(allowed);
}

}  // namespace vdbfuse::tool
