// SPDX-License-Identifier: Apache-2.0
// Writes small E57 files for tests, from the descriptions of the format and with nothing of the reader.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse::test {

struct E57Column {
  std::string name;
  enum class Type { Single, Double, Integer, Scaled, Text } type = Type::Single;
  std::int64_t minimum = 0, maximum = 0;  ///< of the whole numbers of Integer and Scaled
  double scale = 1, offset = 0;
  std::vector<double> values;  ///< one a record, as they are meant; whole numbers are rounded
};

struct E57Part {
  std::string name;
  std::optional<RigidTransform> pose;
  std::vector<E57Column> columns;
  std::string codecs = "";  ///< XML inside <codecs>
};

/// Every bytestream is cut at other places than its neighbours, with index and empty packets in between.
std::string e57File(const std::vector<E57Part>& parts);

/// A file of pages with their checksums around the given logical bytes.
std::string e57Pages(std::string logical);

/// Scans of a view: cartesian floats with row, column, state and a colour; the same as spherical scaled
/// integers; its points alone as doubles.
E57Part cartesianPart(const View& view);
E57Part sphericalPart(const View& view);
E57Part loosePart(const View& view);

}  // namespace vdbfuse::test
