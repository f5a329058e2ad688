// SPDX-License-Identifier: Apache-2.0
#include "formats/e57_points.h"

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using io::littleEndian;

constexpr std::size_t kSectionHeader = 32, kPacketHeader = 4, kDataHeader = 6;

// Walks through the packets of a section.
class SectionReader {
 public:
  SectionReader(const fs::path& path, const E57Scan& scan) : path_(path), scan_(scan), pages_(path) {
    const std::uint64_t start = pages_.logical(scan.section, "the points of " + scan.place);
    const std::string header = pages_.read(start, kSectionHeader, "a section header");
    if (header[0] != 1)
      throw IoError(path, pages_.place(start), "a section of points (1)",
                    "kind " + std::to_string(static_cast<unsigned char>(header[0])));
    const std::uint64_t length = littleEndian(header, 8, 8);
    if (length > pages_.logicalSize() - start)
      throw IoError(path, pages_.place(start + 8), "a section that ends in the file",
                    std::to_string(length) + " bytes");
    end_ = start + length;
    position_ = pages_.logical(littleEndian(header, 16, 8), "the first packet of " + scan.place);
  }

  void decode(E57Decoder& decoder) {
    while (!decoder.isDone()) {
      if (position_ >= end_)
        throw IoError(path_, pages_.place(position_),
                      std::to_string(scan_.record_count) + " records of " + scan_.place,
                      std::to_string(decoder.records()));
      readPacket(decoder);
    }
  }

 private:
  void readPacket(E57Decoder& decoder) {
    const std::string header = pages_.read(position_, kPacketHeader, "a packet header");
    const auto kind = static_cast<unsigned char>(header[0]);
    const std::uint64_t length = littleEndian(header, 2, 2) + 1;
    if (kind > 2) fail("a packet of kind 0, 1 or 2", "kind " + std::to_string(kind));
    if (length % 4 != 0) fail("a packet of a multiple of 4 bytes", std::to_string(length) + " bytes");
    if (kind == 1) {
      const std::string packet = pages_.read(position_, length, "a packet");
      decoder.addPacket(packet, bytestreams(packet));
    }
    position_ += length;
  }

  std::vector<std::size_t> bytestreams(const std::string& packet) const {
    const std::size_t streams = scan_.fields.size();
    std::vector<std::size_t> begins = {kDataHeader + 2 * streams};
    if (begins.front() > packet.size() || littleEndian(packet, 4, 2) != streams)
      fail(std::to_string(streams) + " bytestreams", "another number");
    for (std::size_t i = 0; i < streams; ++i)
      begins.push_back(begins.back() + littleEndian(packet, kDataHeader + 2 * i, 2));
    if (begins.back() > packet.size())
      fail("bytestreams inside their packet", std::to_string(begins.back()) + " bytes");
    return begins;
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw IoError(path_, pages_.place(position_), expected, found);
  }

  const fs::path& path_;
  const E57Scan& scan_;
  io::E57Pages pages_;
  std::uint64_t position_ = 0, end_ = 0;
};

}  // namespace

E57Selection selectFields(const fs::path& path, const E57Scan& scan) {
  static constexpr const char* kCartesian[] = {"cartesianX", "cartesianY", "cartesianZ"};
  static constexpr const char* kSpherical[] = {"sphericalRange", "sphericalAzimuth", "sphericalElevation"};
  E57Selection selection;
  selection.is_spherical =
      !(scan.find(kCartesian[0]) && scan.find(kCartesian[1]) && scan.find(kCartesian[2]));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto field = scan.find(selection.is_spherical ? kSpherical[i] : kCartesian[i]);
    if (!field || scan.fields[*field].type == E57Field::Type::Other)
      throw IoError(path, scan.place + "/points/prototype",
                    "numbers cartesianX, Y, Z or sphericalRange, Azimuth, Elevation",
                    std::string(field ? "no number " : "no ") +
                        (selection.is_spherical ? kSpherical[i] : kCartesian[i]));
    selection.coordinates[i] = *field;
  }
  const auto integer = [&](const char* name) {
    const auto field = scan.find(name);
    const bool is_integer = field && scan.fields[*field].type == E57Field::Type::Integer;
    return is_integer ? field : std::nullopt;
  };
  selection.invalid = integer(selection.is_spherical ? "sphericalInvalidState" : "cartesianInvalidState");
  selection.row = integer("rowIndex"), selection.column = integer("columnIndex");
  return selection;
}

PointScan readE57Points(const fs::path& path, const E57Scan& scan) {
  E57Decoder decoder(scan, selectFields(path, scan));
  SectionReader(path, scan).decode(decoder);
  return decoder.scan();
}

}  // namespace vdbfuse
