// SPDX-License-Identifier: Apache-2.0
// Arrays of numpy (its format 1.0 to 3.0): "\x93NUMPY", version, length of a header, a header that is a
// Python dictionary of descr, fortran_order and shape, then the numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/raster.h"

namespace vdbfuse::io {

struct NpyHeader {
  char kind = 'f';  ///< f float, i signed, u unsigned, b bool
  int bytes = 4;    ///< of a number: 1, 2, 4 or 8
  bool big_endian = false;
  bool fortran_order = false;  ///< the first index runs fastest
  std::vector<std::int64_t> shape;
  std::size_t data_begin = 0;  ///< byte after the header

  std::size_t count() const;  ///< of numbers
  std::string shapeText() const;
};

/// An array with its numbers in memory.
struct NpyArray {
  NpyHeader header;
  std::string bytes;  ///< of the numbers only

  std::size_t rank() const { return header.shape.size(); }
  /// The number at a position in memory. REQUIRES: index < header.count().
  double operator[](std::size_t index) const;
};

/// `bytes` is the file or its beginning; `size` bytes it is long. Throws IoError at `place` (the name of an
/// array in an archive, or empty): numbers that are none of the above (objects, text, complex), a shape that
/// the size contradicts. Nothing is allocated on the word of a header.
NpyHeader parseNpyHeader(const std::filesystem::path& path, const std::string& place, std::string_view bytes,
                         std::uint64_t size);

/// The whole of a .npy file. Throws IoError.
NpyArray readNpy(const std::filesystem::path& path);

/// Numbers of `array` from `first` on as an image of the given size (row by row). REQUIRES: not Fortran
/// order, and there are as many.
Image<float> npyImage(const NpyArray& array, std::size_t first, int width, int height);

/// A .npy file of two dimensions (or three of which one is 1) as a raster. Throws IoError.
RasterHeader readNpyRasterHeader(const std::filesystem::path& path);
Image<float> readNpyRaster(const std::filesystem::path& path);

/// What stands before the numbers in a .npy file, a multiple of 64 bytes; `descr` as numpy names it ("<f4").
std::string formatNpyHeader(const std::string& descr, const std::vector<std::int64_t>& shape);

/// The bytes of a .npy file of little-endian floats of `bytes` (4 or 8) each.
std::string formatNpy(const std::vector<std::int64_t>& shape, const std::vector<double>& values, int bytes);

}  // namespace vdbfuse::io
