// SPDX-License-Identifier: Apache-2.0
#include "formats/range_scan.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "io/file_bytes.h"
#include "io/ply_table.h"
#include "io/text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;

int gridSide(const fs::path& path, const io::PlyHeader& header, const std::string& name) {
  constexpr std::int64_t kLargestSide = 65535;
  const auto found = header.info.find(name);
  if (found == header.info.end())
    throw IoError(path, "", "a line 'obj_info " + name + " N' in the header", "none");
  const auto side = io::parseInteger(found->second);
  if (!side || *side < 1 || *side > kLargestSide)
    throw IoError(path, "obj_info " + name, "a whole number from 1 to 65535", "'" + found->second + "'");
  return static_cast<int>(*side);
}

PointImage emptyGrid(const fs::path& path, const io::PlyHeader& header, std::size_t entries) {
  const int width = gridSide(path, header, "num_cols"), height = gridSide(path, header, "num_rows");
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (pixels != entries)
    throw IoError(path, "element range_grid", std::to_string(pixels) + " entries (num_cols x num_rows)",
                  std::to_string(entries));
  return noPoints(width, height);
}

// The vertex of entry i of the grid; none where it is empty.
std::optional<std::size_t> vertexAt(const fs::path& path, const io::PlyColumn& grid, std::size_t i,
                                    std::size_t vertices) {
  const std::size_t begin = i == 0 ? 0 : grid.ends[i - 1], count = grid.ends[i] - begin;
  if (count == 0) return std::nullopt;
  const double index = grid.values[begin];
  if (count == 1 && index >= 0 && index < static_cast<double>(vertices))
    return static_cast<std::size_t>(index);
  throw IoError(path, "entry " + std::to_string(i) + " of range_grid",
                "no index or one below " + std::to_string(vertices),
                count > 1 ? std::to_string(count) + " indices" : std::to_string(index));
}

// Change of `value` per pixel towards the neighbours on both sides of one pixel: the smaller one where both
// agree in sign, else none, so that the edge of a surface leads nowhere.
double flatterSlope(std::optional<double> back, std::optional<double> ahead) {
  if (!back || !ahead) return back.value_or(ahead.value_or(0));
  if (*back * *ahead <= 0) return 0;
  return std::abs(*back) < std::abs(*ahead) ? *back : *ahead;
}

class PixelCentres {
 public:
  PixelCentres(const PointImage& points, const Projection& projection)
      : seen_(points.width(), points.height()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f& p = points.data()[i];
      const auto hit = p.allFinite() ? project(projection, p.cast<double>()) : std::nullopt;
      if (hit && std::isfinite(hit->depth)) seen_.data()[i] = *hit;
    }
  }

  double depth(int x, int y) const {
    const PixelDepth& here = seen_(x, y);
    if (!(here.depth > 0)) return kInvalidDepth;
    const double across = flatterSlope(slopeAcross(x, y, -1), slopeAcross(x, y, 1));
    const double down = flatterSlope(slopeDown(x, y, -1, across), slopeDown(x, y, 1, across));
    return here.depth - across * (here.x - x) - down * (here.y - y);
  }

 private:
  const PixelDepth* at(int x, int y) const {
    return seen_.contains(x, y) && seen_(x, y).depth > 0 ? &seen_(x, y) : nullptr;
  }
  std::optional<double> slopeAcross(int x, int y, int step) const {
    const PixelDepth *here = at(x, y), *there = at(x + step, y);
    if (there == nullptr || !((there->x - here->x) * step > 0.5)) return std::nullopt;
    return (there->depth - here->depth) / (there->x - here->x);
  }
  // Neighbours in the next row may lie aside, as in interlaced scans.
  std::optional<double> slopeDown(int x, int y, int step, double across) const {
    const PixelDepth *here = at(x, y), *there = at(x, y + step);
    if (there == nullptr || !((there->y - here->y) * step > 0.5)) return std::nullopt;
    return (there->depth - here->depth - across * (there->x - here->x)) / (there->y - here->y);
  }

  Image<PixelDepth> seen_;  // depth 0: nothing
};

}  // namespace

PointImage readRangeScan(const fs::path& path, double scale) {
  const std::string bytes = io::readFileBytes(path);
  const io::PlyHeader header = io::parsePlyHeader(path, bytes);
  const std::array<io::PlySelection, 2> wanted = {
      {{"vertex", {"x", "y", "z"}}, {"range_grid", {"vertex_indices"}}}};
  const auto columns = io::readPlyTable(path, bytes, header, wanted);
  const auto &x = columns[0][0].values, &y = columns[0][1].values, &z = columns[0][2].values;
  const io::PlyColumn& grid = columns[1][0];
  PointImage points = emptyGrid(path, header, grid.ends.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const auto v = vertexAt(path, grid, i, x.size()))
      points.data()[i] = (scale * Eigen::Vector3d(x[*v], y[*v], z[*v])).cast<float>();
  }
  return points;
}

PointImage mirrored(const PointImage& points, bool columns, bool rows) {
  PointImage result = points;
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      result(columns ? points.width() - 1 - x : x, rows ? points.height() - 1 - y : y) = points(x, y);
    }
  }
  return result;
}

Image<float> depthAtCentres(const PointImage& points, const Projection& projection) {
  const PixelCentres centres(points, projection);
  Image<float> depth(points.width(), points.height(), kInvalidDepth);
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) depth(x, y) = static_cast<float>(centres.depth(x, y));
  }
  normaliseInvalid(depth);
  return depth;
}

}  // namespace vdbfuse
