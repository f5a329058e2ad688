// SPDX-License-Identifier: Apache-2.0
// The XML of an E57 file: which scans there are, and what a record of each is made of.
//
//   e57Root / data3D / vectorChild (one a scan) /
//     name
//     pose / rotation / w x y z,  pose / translation / x y z
//     points (fileOffset, recordCount) / prototype / cartesianX …, codecs
//
// An element without text is the number 0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// One number of a record. A Float is stored as its bytes; an integer v in [minimum, maximum] as v − minimum
/// in as few bits as maximum − minimum needs, and means v·scale + offset.
struct E57Field {
  std::string name;
  enum class Type { Single, Double, Integer, Other } type = Type::Other;
  std::int64_t minimum = 0;
  double scale = 1, offset = 0;
  int bits = 0;
};

struct E57Scan {
  std::string name;
  std::string place;  ///< for messages: "data3D[0]"
  std::optional<RigidTransform> world_from_scanner;
  std::uint64_t section = 0;       ///< physical offset of its points
  std::uint64_t record_count = 0;  ///< never more than the file has room for
  std::vector<E57Field> fields;    ///< all, in the order of their bytestreams

  /// Index of the field; none when there is none of that name.
  std::optional<std::size_t> find(const std::string& field) const;
};

/// Throws IoError: no XML, no scans, numbers that are none, codecs other than bitpack, poses that are no
/// rigid transform, more records in all than would fit into `file_bytes` with three bytes each.
std::vector<E57Scan> parseE57(const std::filesystem::path& path, const std::string& xml,
                              std::uint64_t file_bytes);

}  // namespace vdbfuse
