// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace vdbfuse::tool {

/// Breaks lines at spaces so that none is longer than `width`; `indent` spaces before all but the first.
/// Line breaks in the text stay.
std::string wrap(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace vdbfuse::tool
