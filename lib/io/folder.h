// SPDX-License-Identifier: Apache-2.0
// What lies in a folder.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vdbfuse {

/// Names of the regular files directly in `folder` that end with `suffix` and are longer than it, hidden
/// files left out, sorted byte by byte; empty when the folder does not exist. Throws IoError when it cannot
/// be read.
std::vector<std::string> filesEndingWith(const std::filesystem::path& folder, std::string_view suffix);

/// Whether there is a regular file of that name; false, too, for names that no file can have.
bool isFile(const std::filesystem::path& path);

/// The files that end with one of the suffixes, by name with runs of digits by value: 2 before 10.
std::vector<std::string> filesInOrder(const std::filesystem::path& folder,
                                      std::span<const char* const> suffixes);

/// The first of `folder`/`stem` + one of .png, .jpg, .jpeg that exists; empty when none does.
std::filesystem::path findPicture(const std::filesystem::path& folder, const std::string& stem);

/// `folder`/`relative`, for a path that a file of the data set names at `place`. Throws IoError when it is
/// absolute or leads out of `folder`: a data set must not make us open files that lie elsewhere.
std::filesystem::path pathInside(const std::filesystem::path& folder, const std::string& relative,
                                 const std::filesystem::path& named_in, const std::string& place);

/// "1 depth map", "3 depth maps": for messages.
std::string counted(std::size_t count, const std::string& noun);

}  // namespace vdbfuse
