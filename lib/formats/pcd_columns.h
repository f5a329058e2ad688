// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "formats/pcd_header.h"

namespace vdbfuse::io {

/// The named fields of all points of an ascii or binary cloud, organised or not: a column of numbers each, in
/// the order of `names`. `bytes` is the whole file and `layout` what parsePcdLayout() says of it. Counts are
/// checked against the file's size before anything is allocated. Throws IoError: the cloud is compressed, a
/// field is missing or holds several values, the file ends before its last point.
std::vector<std::vector<double>> readPcdColumns(const std::filesystem::path& path, std::string_view bytes,
                                                const PcdLayout& layout,
                                                const std::vector<std::string>& names);

}  // namespace vdbfuse::io
