// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vdbfuse::io {

/// Writes an uncompressed archive as numpy.savez() does; every array is gathered in a hidden file beside it,
/// so that no more than one part is in memory. The same arrays give the same bytes.
class NpzWriter {
 public:
  /// `parts`: the length of the first dimension of all arrays; none: each array is one part without it.
  NpzWriter(std::filesystem::path path, std::optional<std::int64_t> parts);
  ~NpzWriter();
  NpzWriter(const NpzWriter&) = delete;
  NpzWriter& operator=(const NpzWriter&) = delete;

  /// The next part of the array of that name; `descr` is numpy's name of its numbers ("<f4"). Throws IoError.
  void append(const std::string& name, const std::string& descr, const std::vector<std::int64_t>& shape,
              std::string_view bytes);
  /// Puts the archive in place, complete or not at all. Arrays that did not get all their parts, or parts of
  /// several shapes, are left out. Throws IoError.
  void finish();

 private:
  struct Array {
    std::vector<std::int64_t> shape;  // of a part
    std::int64_t parts = 0;
    std::filesystem::path file;
    std::ofstream stream;
  };
  std::filesystem::path path_;
  std::optional<std::int64_t> parts_;
  std::map<std::string, Array> arrays_;
};

}  // namespace vdbfuse::io
