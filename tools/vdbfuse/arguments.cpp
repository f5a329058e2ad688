// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <cstdio>

#include "cli/one_of.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::tool {

std::pair<int, int> parseSize(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) != 2 || width <= 0 || height <= 0)
    throw CLI::ValidationError("--size", "expected WIDTHxHEIGHT, found '" + text + "'");
  return {width, height};
}

Eigen::Vector3d axisNamed(const std::string& name) {
  const double sign = name.front() == '-' ? -1 : 1;
  return sign * Eigen::Vector3d::Unit(name.back() - 'x');
}

CLI::Validator axisCheck() { return oneOf({"x", "y", "z", "-x", "-y", "-z"}); }

std::optional<Box> boxOf(const std::vector<double>& b) {
  if (b.empty()) return std::nullopt;
  const Box box(Eigen::Vector3d(b[0], b[1], b[2]), Eigen::Vector3d(b[3], b[4], b[5]));
  if (box.isEmpty()) throw InvalidArgument("--bbox", "the lower corner must come first");
  return box;
}

void refuse(const std::string& argument, const std::vector<std::string>& problems) {
  std::string all;
  for (const std::string& p : problems) all += (all.empty() ? "" : "; ") + p;
  if (!all.empty()) throw CLI::ValidationError(argument, all);
}

}  // namespace vdbfuse::tool
