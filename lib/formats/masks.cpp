// SPDX-License-Identifier: Apache-2.0
#include "formats/masks.h"

#include <algorithm>
#include <memory>

#include "io/folder.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

fs::path maskBeside(const fs::path& data, const std::string& name) {
  for (const fs::path& candidate : {data / "masks" / (name + ".png"), data / (name + ".mask.png")}) {
    std::error_code error;
    if (fs::is_regular_file(candidate, error)) return candidate;
  }
  return {};
}

fs::path maskIn(const fs::path& folder, const std::string& name) {
  const fs::path path = folder / (name + ".png");
  if (!fs::exists(path)) throw IoError(path, "", "the mask of view " + name, "nothing of that name");
  return path;
}

}  // namespace

std::vector<fs::path> maskPaths(const std::vector<std::string>& names, const fs::path& data,
                                const fs::path& folder) {
  if (!folder.empty() && !fs::is_directory(folder))
    throw IoError(folder, "", "a folder of masks", fs::exists(folder) ? "a file" : "nothing of that name");
  std::vector<fs::path> paths;
  for (const std::string& name : names)
    paths.push_back(folder.empty() ? maskBeside(data, name) : maskIn(folder, name));
  return paths;
}

// Any kind of 8-bit picture will do; of 16 bits a reader of pictures would drop the lower eight.
void checkMask(const fs::path& path, int width, int height, const std::string& image) {
  const PngHeader header = readPngHeader(path);
  if (header.width != width || header.height != height) {
    throw IoError(path, "", "a mask of " + sizeText(width, height) + " pixels as the " + image,
                  sizeText(header.width, header.height));
  }
  if (header.bits > 8)
    throw IoError(path, "", "a mask of at most 8 bits", std::to_string(header.bits) + " bits");
}

Image<std::uint8_t> readMask(const fs::path& path) {
  const Image<Rgb8> picture = readPngRgb(path);
  Image<std::uint8_t> mask(picture.width(), picture.height());
  std::transform(picture.begin(), picture.end(), mask.begin(),
                 [](const Rgb8& c) -> std::uint8_t { return c[0] != 0 || c[1] != 0 || c[2] != 0 ? 255 : 0; });
  return mask;
}

void addMasks(DepthSet& set, const fs::path& data, const fs::path& folder) {
  std::vector<ViewHeader> headers;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < set.views.size(); ++i) {
    headers.push_back(set.views.header(i));
    names.push_back(headers.back().name);
  }
  const auto paths = std::make_shared<const std::vector<fs::path>>(maskPaths(names, data, folder));
  std::size_t found = 0;
  for (std::size_t i = 0; i < paths->size(); ++i) {
    if ((*paths)[i].empty()) continue;
    checkMask((*paths)[i], imageWidth(headers[i].projection), imageHeight(headers[i].projection),
              "depth map");
    ++found;
  }
  if (found == 0) return;
  set.notes.push_back("silhouette masks for " + std::to_string(found) + " of " +
                      counted(headers.size(), "view"));
  set.views = ViewSequence(std::move(headers), [paths, plain = set.views](std::size_t index) {
    DepthMap map = plain.load(index).map;
    if (!(*paths)[index].empty()) map.mask = readMask((*paths)[index]);
    return map;
  });
}

}  // namespace vdbfuse
