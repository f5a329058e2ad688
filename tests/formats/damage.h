// SPDX-License-Identifier: Apache-2.0
// Random damage to the files of a sample.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "formats/samples.h"

namespace vdbfuse::test {

#if defined(__SANITIZE_ADDRESS__)  // g++
constexpr bool kSanitized = true;
#elif defined(__has_feature)  // clang++
constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kSanitized = false;
#endif

/// Writes the sample, damages one of its files at a time, `trials` times, and has it read. Fails when
/// `is_refused(input, format)` throws, is true without damage, takes too long or, outside the sanitizers,
/// more than a gibibyte of memory, or when hardly any damage is refused.
void expectReadOrRefused(
    const Sample& sample, int trials,
    const std::function<bool(const std::filesystem::path& input, const std::string& format)>& is_refused);

}  // namespace vdbfuse::test
