// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_pages.h"

#include <algorithm>
#include <array>

#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

constexpr std::size_t kHeaderBytes = 48;
constexpr std::string_view kSignature = "ASTM-E57";

// A fuzzer would never get past them.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr bool kChecksumsMatter = false;
#else
constexpr bool kChecksumsMatter = true;
#endif

constexpr std::array<std::uint32_t, 256> crcTable() {
  constexpr std::uint32_t kReversedPolynomial = 0x82F63B78;
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1) != 0 ? kReversedPolynomial : 0);
    table[byte] = value;
  }
  return table;
}

std::uint32_t bigEndian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

}  // namespace

std::uint32_t crc32c(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = crcTable();
  std::uint32_t value = 0xFFFFFFFF;
  for (const char c : bytes) value = (value >> 8) ^ kTable[(value ^ static_cast<unsigned char>(c)) & 0xFF];
  return ~value;
}

std::uint64_t littleEndian(std::string_view bytes, std::size_t offset, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[offset + i]);
  return value;
}

E57Pages::E57Pages(const std::filesystem::path& path) : path_(path) {
  const std::uint64_t size = fileSize(path);
  const std::string header = readFileStart(path, kHeaderBytes);
  if (!header.starts_with(kSignature)) throw IoError(path, "byte 0", "ASTM-E57", "another signature");
  if (header.size() < kHeaderBytes)
    throw IoError(path, "byte " + std::to_string(size), "a header of 48 bytes", "the end of the file");
  if (const std::uint64_t major = littleEndian(header, 8, 4); major != 1)
    throw IoError(path, "byte 8", "E57 version 1", "version " + std::to_string(major));
  const std::uint64_t length = littleEndian(header, 16, 8);
  page_size_ = littleEndian(header, 40, 8);
  if (page_size_ < 64 || page_size_ > (1 << 20) || page_size_ % 4 != 0)
    throw IoError(path, "byte 40", "pages of 64 to 1048576 bytes", std::to_string(page_size_));
  if (length > size || length % page_size_ != 0)
    throw IoError(path, "byte 16", "the length of the file in whole pages",
                  std::to_string(length) + " where the file has " + std::to_string(size) + " bytes");
  pages_ = length / page_size_;
  xml_offset_ = littleEndian(header, 24, 8), xml_length_ = littleEndian(header, 32, 8);
  file_.open(path, std::ios::binary);
  if (!file_) throw IoError(path, "cannot be opened");
}

std::string E57Pages::xml() {
  constexpr std::uint64_t kLargest = std::uint64_t{1} << 26;  // of all tags in memory some twenty times that
  if (xml_length_ > kLargest)
    throw IoError(path_, "byte 32", "an XML section of at most 67108864 bytes", std::to_string(xml_length_));
  return read(logical(xml_offset_, "the XML section"), xml_length_, "an XML section");
}

std::uint64_t E57Pages::logical(std::uint64_t physical, const std::string& what) const {
  const std::uint64_t page = physical / page_size_, within = physical % page_size_;
  if (page >= pages_ || within >= payload())
    throw IoError(path_, "byte " + std::to_string(physical), what,
                  page >= pages_ ? "the end of the file" : "a checksum");
  return page * payload() + within;
}

std::string E57Pages::place(std::uint64_t offset) const {
  return "byte " + std::to_string(offset / payload() * page_size_ + offset % payload());
}

std::string E57Pages::read(std::uint64_t offset, std::uint64_t count, const std::string& what) {
  const std::uint64_t size = logicalSize();
  if (offset > size || count > size - offset)
    throw IoError(path_, place(std::min(offset, size)), what + " of " + std::to_string(count) + " bytes",
                  "the end of the file");
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(count));
  for (std::uint64_t end = offset + count; offset < end;) {
    const std::uint64_t page = offset / payload(), within = offset % payload();
    const std::uint64_t part = std::min(payload() - within, end - offset);
    appendPage(page, within, within + part, bytes);
    offset += part;
  }
  return bytes;
}

void E57Pages::appendPage(std::uint64_t page, std::uint64_t begin, std::uint64_t end, std::string& bytes) {
  page_.resize(page_size_);
  file_.seekg(static_cast<std::streamoff>(page * page_size_));
  if (!file_.read(page_.data(), static_cast<std::streamsize>(page_size_)))
    throw IoError(path_, "changed since it was opened");
  const std::string_view view(page_);
  if (kChecksumsMatter && crc32c(view.substr(0, payload())) != bigEndian(view.substr(payload())))
    throw IoError(path_, "byte " + std::to_string(page * page_size_ + payload()),
                  "the checksum of page " + std::to_string(page), "another: the file is damaged");
  bytes.append(view.substr(begin, end - begin));
}

}  // namespace vdbfuse::io
