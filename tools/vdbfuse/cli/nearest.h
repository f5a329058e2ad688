// SPDX-License-Identifier: Apache-2.0
// Which word was meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vdbfuse::tool {

/// Letters to insert, leave out, replace, or swap with their neighbour, to make `b` of `a` (Damerau and
/// Levenshtein, no letter touched twice).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The word that `typed` is most likely meant to be: at most a third of its letters are wrong, or it is the
/// beginning of that word alone. Nothing when none is near.
std::optional<std::string> nearest(const std::string& typed, const std::vector<std::string>& words);

/// "; did you mean 'voxel'?", or nothing.
std::string didYouMean(const std::string& typed, const std::vector<std::string>& words);

}  // namespace vdbfuse::tool
