// SPDX-License-Identifier: Apache-2.0
// The binary section of one scan of an E57 file (logical bytes, all little-endian):
//
//   byte  0  uint8 1, 7 bytes reserved
//         8  uint64 logical length of the section
//        16  uint64 physical offset of the first packet, uint64 of the first index packet
//   then packets:
//         0  uint8 kind: 0 index, 1 data, 2 empty; uint8 flags; uint16 length − 1
//   data  4  uint16 number of bytestreams, uint16 length of each, the bytestreams one after the other
//
// A bytestream holds one field of all records, packed without gaps from the lowest bit of a byte up; it goes
// on from packet to packet, and packets need not hold as many records of one field as of another.
#pragma once

#include "formats/e57_decoder.h"
#include "formats/e57_pages.h"
#include "formats/e57_scan.h"
#include "formats/point_views.h"

namespace vdbfuse {

/// Throws IoError when coordinates are missing or no numbers.
E57Selection selectFields(const std::filesystem::path& path, const E57Scan& scan);

/// The valid points in camera axes: an upright image when all know their row and column and fill more than a
/// 16th of it, loose otherwise. Throws IoError.
PointScan readE57Points(const std::filesystem::path& path, const E57Scan& scan);

}  // namespace vdbfuse
