// SPDX-License-Identifier: Apache-2.0
// Choosing from a table of formats, of depth maps or of photographs, by name or by looking.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// What lies at `path`, for someone who wonders why it is not known: "a folder of a/, b, c and 3 more".
std::string contentsOf(const std::filesystem::path& path);

/// Throws IoError unless `folder` can be made and is empty.
void requireEmptyFolder(const std::filesystem::path& folder);

enum class Ability { Read, Write };

/// "rgbd, tum, open3d".
template <class Format>
std::string formatNames(const std::vector<Format>& formats, Ability ability) {
  std::string names;
  for (const Format& format : formats) {
    if (ability == Ability::Write && format.write == nullptr) continue;
    if (!names.empty()) names += ", ";
    names += format.name;
  }
  return names;
}

/// Throws InvalidArgument when there is none.
template <class Format>
const Format& formatNamed(const std::vector<Format>& formats, const std::string& name) {
  for (const Format& format : formats) {
    if (format.name == name) return format;
  }
  throw InvalidArgument("format",
                        "expected one of " + formatNames(formats, Ability::Read) + ", found '" + name + "'");
}

/// The one that fits best. Throws IoError when none does; `what` is what was looked for: "a data set".
template <class Format>
const Format& bestFormat(const std::vector<Format>& formats, const std::filesystem::path& path,
                         const std::string& what) {
  const Format* best = nullptr;
  Detection::Fit best_fit = Detection::Fit::No;
  for (const Format& format : formats) {
    const Detection found = format.detect(path);
    if (found.fit > best_fit) best = &format, best_fit = found.fit;
  }
  if (best == nullptr)
    throw IoError(path, "", what + " of a known format (vdbfuse formats PATH says what each lacks)",
                  contentsOf(path));
  return *best;
}

}  // namespace vdbfuse
