// SPDX-License-Identifier: Apache-2.0
// The bytes of an E57 file under its checksums. All numbers are little-endian but the checksums.
//
//   byte  0  "ASTM-E57"
//         8  uint32 major version 1, uint32 minor version
//        16  uint64 length of the file
//        24  uint64 physical offset of the XML, uint64 its logical length
//        40  uint64 page size, 1024
//
// The file is pages; the last four bytes of a page are the CRC-32C of the others, big-endian. Physical
// offsets count all bytes, logical ones leave the checksums out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace vdbfuse::io {

/// An open file. `path` must outlive it.
class E57Pages {
 public:
  /// Reads the header. Throws IoError when it is unsound or the file shorter than it says.
  explicit E57Pages(const std::filesystem::path& path);

  /// The XML section. Throws IoError as read().
  std::string xml();
  /// Logical bytes [offset, offset + count). Throws IoError when there are fewer, or a checksum is wrong;
  /// `what` names them.
  std::string read(std::uint64_t offset, std::uint64_t count, const std::string& what);
  /// The logical offset of a physical one. Throws IoError when it is outside the file or in a checksum.
  std::uint64_t logical(std::uint64_t physical, const std::string& what) const;
  /// "byte N" of a logical offset in the file.
  std::string place(std::uint64_t offset) const;
  std::uint64_t logicalSize() const { return pages_ * payload(); }

 private:
  std::uint64_t payload() const { return page_size_ - 4; }
  void appendPage(std::uint64_t page, std::uint64_t begin, std::uint64_t end, std::string& bytes);

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::string page_;
  std::uint64_t page_size_ = 1024, pages_ = 0, xml_offset_ = 0, xml_length_ = 0;
};

/// CRC-32C (Castagnoli).
std::uint32_t crc32c(std::string_view bytes);

/// The little-endian number at `offset`. REQUIRES: the bytes are there.
std::uint64_t littleEndian(std::string_view bytes, std::size_t offset, std::size_t size);

}  // namespace vdbfuse::io
