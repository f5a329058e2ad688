// SPDX-License-Identifier: Apache-2.0
#include "io/exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>

#include <algorithm>
#include <mutex>
#include <string>

#include "io/image_size.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;
constexpr int kLargestSide = 32768;

// The library looks no further at a header that asks for more.
void limitSizes() {
  static std::once_flag once;
  std::call_once(once, [] {
    Imf::Header::setMaxImageSize(kLargestSide, kLargestSide);
    Imf::Header::setMaxTileSize(kLargestSide, kLargestSide);
  });
}

struct Channel {
  std::string name;
  Imf::PixelType type;
};

Channel depthChannel(const fs::path& path, const Imf::ChannelList& channels) {
  std::size_t count = 0;
  std::string names;
  for (auto c = channels.begin(); c != channels.end(); ++c, ++count)
    names += (names.empty() ? "" : ", ") + std::string(c.name());
  const auto usable = [](const Imf::Channel* c) { return c && c->xSampling == 1 && c->ySampling == 1; };
  for (const char* name : {"Z", "depth.Z", "depth", "Depth", "Y", "V"}) {
    if (const Imf::Channel* c = channels.findChannel(name); usable(c)) return {name, c->type};
  }
  if (count == 1 && usable(&channels.begin().channel()))
    return {channels.begin().name(), channels.begin().channel().type};
  throw IoError(path, "", "a channel Z", count == 0 ? "none" : names);
}

RasterHeader headerOf(const fs::path& path, const Imf::Header& header) {
  const Imath::Box2i& window = header.displayWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                     height = std::int64_t{window.max.y} - window.min.y + 1;
  checkImageSize(path, "", width, height);
  const Channel channel = depthChannel(path, header.channels());
  RasterHeader result{RasterKind::Exr, static_cast<int>(width), static_cast<int>(height), 32,
                      RasterHeader::Number::Float};
  if (channel.type == Imf::HALF) result.bits = 16;
  if (channel.type == Imf::UINT) result.number = RasterHeader::Number::Unsigned;
  return result;
}

// The library's own words, on one line.
template <class Action>
auto withFileErrors(const fs::path& path, const Action& action) {
  limitSizes();
  try {
    return action();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    std::string words = error.what();
    std::replace(words.begin(), words.end(), '\n', ' ');
    throw IoError(path, "", "a sound EXR file", words);
  }
}

// Pixels of the data window, which need not be those of the image.
Image<float> readWindow(Imf::InputFile& file, const std::string& channel, const Imath::Box2i& window) {
  Image<float> pixels(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1);
  const auto width = static_cast<std::ptrdiff_t>(pixels.width());
  char* const origin = reinterpret_cast<char*>(pixels.data()) -
                       static_cast<std::ptrdiff_t>(sizeof(float)) * (window.min.x + width * window.min.y);
  Imf::FrameBuffer buffer;
  buffer.insert(channel, Imf::Slice(Imf::FLOAT, origin, sizeof(float),
                                    sizeof(float) * static_cast<std::size_t>(width)));
  file.setFrameBuffer(buffer);
  file.readPixels(window.min.y, window.max.y);
  return pixels;
}

}  // namespace

RasterHeader readExrHeader(const fs::path& path) {
  return withFileErrors(path, [&] {
    const Imf::InputFile file(path.c_str(), 1);
    return headerOf(path, file.header());
  });
}

Image<float> readExr(const fs::path& path) {
  return withFileErrors(path, [&] {
    Imf::InputFile file(path.c_str(), 1);
    const RasterHeader header = headerOf(path, file.header());
    const Imath::Box2i data = file.header().dataWindow(), display = file.header().displayWindow();
    checkImageSize(path, "", std::int64_t{data.max.x} - data.min.x + 1,
                   std::int64_t{data.max.y} - data.min.y + 1);
    if (!file.isComplete()) throw IoError(path, "", "a complete EXR file", "one whose end is missing");
    const Image<float> pixels = readWindow(file, depthChannel(path, file.header().channels()).name, data);
    if (data == display) return pixels;
    Image<float> image(header.width, header.height, 0.0f);
    for (int y = 0; y < pixels.height(); ++y) {
      for (int x = 0; x < pixels.width(); ++x) {
        const int u = x + data.min.x - display.min.x, v = y + data.min.y - display.min.y;
        if (image.contains(u, v)) image(u, v) = pixels(x, y);
      }
    }
    return image;
  });
}

void writeExr(const fs::path& path, const Image<float>& image) {
  AtomicFile target(path);
  withFileErrors(path, [&] {
    Imf::Header header(image.width(), image.height());
    header.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    Imf::OutputFile file(target.temporaryPath().c_str(), header, 1);
    Imf::FrameBuffer buffer;
    buffer.insert("Z", Imf::Slice(Imf::FLOAT, const_cast<char*>(reinterpret_cast<const char*>(image.data())),
                                  sizeof(float), sizeof(float) * static_cast<std::size_t>(image.width())));
    file.setFrameBuffer(buffer);
    file.writePixels(image.height());
  });
  target.commit();
}

}  // namespace vdbfuse::io
