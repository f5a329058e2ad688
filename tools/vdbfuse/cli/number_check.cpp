// SPDX-License-Identifier: Apache-2.0
#include "cli/number_check.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string>

namespace vdbfuse::tool {
namespace {

CLI::Validator numberThat(const std::function<bool(double)>& fits, const std::string& expected) {
  const auto check = [fits, expected](const std::string& text) {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && fits(value)) return std::string();
    return "expected a number " + expected + ", found '" + text + "'";
  };
  return CLI::Validator("").operation([check](std::string& text) { return check(text); });
}

}  // namespace

CLI::Validator positiveNumber() {
  return numberThat([](double value) { return value > 0; }, "above 0");
}

CLI::Validator nonNegativeNumber() {
  return numberThat([](double value) { return value >= 0; }, "of 0 or more");
}

CLI::Validator numberBetween(double low, double high) {
  char text[64];
  std::snprintf(text, sizeof text, "from %g to %g", low, high);
  return numberThat([low, high](double value) { return value >= low && value <= high; }, text);
}

}  // namespace vdbfuse::tool
