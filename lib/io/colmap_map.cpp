// SPDX-License-Identifier: Apache-2.0
#include "io/colmap_map.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string>

#include "io/file_bytes.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::size_t kLongestHeader = 64;

struct Header {
  std::array<std::int64_t, 3> sides{};
  std::size_t data_begin = 0;
};

Header parseHeader(const std::filesystem::path& path) {
  const std::string start = readFileStart(path, kLongestHeader);
  Header header;
  for (std::int64_t& side : header.sides) {
    const char *begin = start.data() + header.data_begin, *end = start.data() + start.size();
    const auto [stop, error] = std::from_chars(begin, end, side);
    if (error != std::errc{} || stop == end || *stop != '&')
      throw IoError(path, "byte " + std::to_string(header.data_begin), "width&height&channels&",
                    "something else");
    header.data_begin = static_cast<std::size_t>(stop - start.data()) + 1;
  }
  const auto& [width, height, channels] = header.sides;
  checkImageSize(path, "", width, height);
  if (channels != 1) throw IoError(path, "", "a map of one channel", std::to_string(channels) + " channels");
  const std::uint64_t size = fileSize(path),
                      expected = header.data_begin + 4 * static_cast<std::uint64_t>(width * height);
  if (size != expected)
    throw IoError(path, "", std::to_string(expected) + " bytes for " + sizeText(width, height) + " pixels",
                  std::to_string(size));
  return header;
}

}  // namespace

bool isColmapMap(std::string_view start) {
  const std::size_t digits = start.find_first_not_of("0123456789");
  return digits != start.npos && digits > 0 && start[digits] == '&';
}

RasterHeader readColmapMapHeader(const std::filesystem::path& path) {
  const Header header = parseHeader(path);
  return {RasterKind::Colmap, static_cast<int>(header.sides[0]), static_cast<int>(header.sides[1]), 32,
          RasterHeader::Number::Float};
}

Image<float> readColmapMap(const std::filesystem::path& path) {
  const Header header = parseHeader(path);
  const std::string bytes = readFileBytes(path);
  Image<float> image(static_cast<int>(header.sides[0]), static_cast<int>(header.sides[1]));
  if (bytes.size() != header.data_begin + 4 * image.size())
    throw IoError(path, "", "a file as long as before", std::to_string(bytes.size()) + " bytes");
  std::memcpy(image.data(), bytes.data() + header.data_begin, 4 * image.size());
  return image;
}

void writeColmapMap(const std::filesystem::path& path, const std::vector<Image<float>>& channels) {
  const Image<float>& first = channels.front();
  std::string bytes;
  for (const std::size_t side :
       {static_cast<std::size_t>(first.width()), static_cast<std::size_t>(first.height()), channels.size()})
    bytes += std::to_string(side) + "&";
  for (const Image<float>& channel : channels)
    bytes.append(reinterpret_cast<const char*>(channel.data()), 4 * channel.size());
  writeFileBytes(path, bytes);
}

}  // namespace vdbfuse::io
