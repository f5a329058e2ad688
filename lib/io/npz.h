// SPDX-License-Identifier: Apache-2.0
// Arrays of numpy that stay in their files and are read in parts: .npy files, and the entries NAME.npy of
// .npz archives (zip files, stored or deflated).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/npy.h"

namespace vdbfuse::io {

/// Copies share what they hold. read() may be called from several threads.
class StoredArray {
 public:
  /// A .npy file. Throws IoError.
  explicit StoredArray(std::filesystem::path path);
  /// The array of that name in a .npz archive. Throws IoError at "array 'NAME'": the archive is broken, the
  /// entry encrypted, compressed in another way, or larger than its compressed bytes can make it.
  StoredArray(std::filesystem::path path, std::string name);

  const NpyHeader& header() const { return header_; }
  const std::filesystem::path& path() const { return path_; }
  /// "array 'NAME'", or empty for a file.
  const std::string& place() const { return place_; }

  /// Numbers [first, first + count) in C order, as an array of one dimension. Reads only them where the file
  /// can be sought in. Compressed arrays and those in Fortran order are read whole, and held from then on
  /// when they were asked for in parts. Throws IoError. REQUIRES: there are as many.
  NpyArray read(std::size_t first, std::size_t count) const;

 private:
  struct Whole;
  std::string bytes(std::uint64_t first, std::uint64_t count) const;
  std::string allInRowOrder() const;

  std::filesystem::path path_;
  std::string name_, place_;
  std::uint64_t size_ = 0;  // with the header
  bool is_compressed_ = false;
  NpyHeader header_;
  std::shared_ptr<Whole> whole_;
};

/// Whether the first bytes are those of a zip file with something in it.
bool isNpz(const std::filesystem::path& path);

/// Names of the arrays of an archive, without ".npy", in its order. Throws IoError.
std::vector<std::string> npzNames(const std::filesystem::path& path);

}  // namespace vdbfuse::io
