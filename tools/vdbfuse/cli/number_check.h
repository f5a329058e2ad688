// SPDX-License-Identifier: Apache-2.0
// Checks of numbers whose complaints say what was expected and what was found.
#pragma once

#include <CLI/App.hpp>

namespace vdbfuse::tool {

CLI::Validator positiveNumber();
CLI::Validator nonNegativeNumber();
/// Both ends are allowed.
CLI::Validator numberBetween(double low, double high);

}  // namespace vdbfuse::tool
