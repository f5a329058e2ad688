// SPDX-License-Identifier: Apache-2.0
// What reading TIFF files takes, whatever is in them.
#pragma once

#include <tiffio.h>

#include <filesystem>
#include <memory>
#include <string>

namespace vdbfuse::io {

/// What the tags of the first image say.
struct TiffTags {
  int width = 0, height = 0;
  int bits = 1, samples = 1;
  int number = SAMPLEFORMAT_UINT;
  int photometric = PHOTOMETRIC_MINISBLACK;
  bool is_tiled = false, is_planar = false;
  bool has_alpha = false;
};

/// An open file; the library's complaints become IoErrors. `path` must outlive it.
class TiffFile {
 public:
  /// Throws IoError, also when the image is of a size beyond reason.
  explicit TiffFile(const std::filesystem::path& path);
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  const TiffTags& tags() const { return tags_; }
  TIFF* get() const { return tiff_.get(); }
  /// Row `y`, of bytesOfRow() bytes. Throws IoError.
  void readRow(int y, unsigned char* row) const;
  std::size_t bytesOfRow() const { return static_cast<std::size_t>(TIFFScanlineSize(tiff_.get())); }
  /// An IoError with the library's first complaint.
  [[noreturn]] void fail() const;

 private:
  const std::filesystem::path& path_;
  std::string error_;
  std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff_;
  TiffTags tags_;
};

}  // namespace vdbfuse::io
