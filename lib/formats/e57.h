// SPDX-License-Identifier: Apache-2.0
// E57 (ASTM E2807, version 1.0): laser scans with poses. The file is pages of 1024 bytes, the last four of
// each a checksum (e57_pages.h); a section of XML (e57_scan.h) names the scans, and a binary section holds
// each one's points (e57_points.h).
//
// Read: data3D with cartesianX/Y/Z or sphericalRange/Azimuth/Elevation as Float, ScaledInteger or Integer, in
// the scanner's axes x forward, y left, z up (azimuth from x to y, elevation above the level), metres and
// radians; points whose cartesianInvalidState or sphericalInvalidState is not 0 are left out. Scans with
// rowIndex and columnIndex become images, others loose points. world_from_scanner is the pose. Colours,
// intensities, images2D and all other fields are passed over.
//
// Refused: codecs other than bitpack, a missing pose among several scans.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads the XML, and every scan once to find its sensor; points are read again when a depth map is asked
/// for. Throws IoError: a checksum is wrong, a section is unsound or too short, fields are missing.
DepthSet readE57(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat e57Format();

}  // namespace vdbfuse
