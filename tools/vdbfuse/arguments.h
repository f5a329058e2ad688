// SPDX-License-Identifier: Apache-2.0
// Kinds of arguments that several subcommands share. Wrong ones throw CLI::ValidationError: exit code 2.
#pragma once

#include <CLI/Error.hpp>
#include <CLI/Validators.hpp>
#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vdbfuse/geometry/box.h"

namespace vdbfuse::tool {

/// "640x480" as (width, height), both positive.
std::pair<int, int> parseSize(const std::string& text);

/// x, y, z, -x, -y or -z. REQUIRES: axisCheck() has passed.
Eigen::Vector3d axisNamed(const std::string& name);
CLI::Validator axisCheck();

/// x0,y0,z0,x1,y1,z1 as a box; nothing of nothing. Throws InvalidArgument when the lower corner does not come
/// first.
std::optional<Box> boxOf(const std::vector<double>& numbers);

/// One error of all that validate() found; does nothing when there is nothing.
void refuse(const std::string& argument, const std::vector<std::string>& problems);

}  // namespace vdbfuse::tool
