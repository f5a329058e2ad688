// SPDX-License-Identifier: Apache-2.0
// Which files of a folder hold which arrays of numpy.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/numpy_arrays.h"

namespace vdbfuse {

/// A .npz file, or a .npy file and what its array is called.
struct ArrayFile {
  std::filesystem::path path;
  std::string name;
};

/// Which files hold what; nothing is opened yet.
struct NumpyLayout {
  std::vector<ArrayFile> shared;                ///< arrays of all frames
  std::vector<std::string> names;               ///< of frames that have files of their own; empty: none have
  std::vector<std::vector<ArrayFile>> own;      ///< their files, by frame
  std::vector<std::filesystem::path> pictures;  ///< by frame, may be empty
};

/// `path` is a .npz file or a folder. Throws IoError when the folder cannot be read.
NumpyLayout layoutOf(const std::filesystem::path& path);

/// Opens the arrays. Throws IoError.
ArrayGroup groupOf(const std::vector<ArrayFile>& files);

}  // namespace vdbfuse
