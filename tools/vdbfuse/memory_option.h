// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>

namespace vdbfuse::tool {

/// --memory SIZE: bytes, or a number with KiB, MiB, GiB, TiB (K, M, G, T mean the same) or kB, MB, GB, TB.
CLI::Option* addMemoryOption(CLI::App& app, std::size_t& bytes);

}  // namespace vdbfuse::tool
