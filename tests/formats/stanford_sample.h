// SPDX-License-Identifier: Apache-2.0
// The tiny scene scanned by a sheet of light that moves sideways, as the Stanford repository stores scans.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse::test {

/// Two views of 40×30 pixels by a PushBroom with shear; pixel (0, 0) is invalid.
std::vector<View> tinyPushBroomViews();

/// scans.conf and scanN.ply, ascii, row 0 at the bottom, the scan's origin 1.9 m in front of the sensor.
void writeStanfordAscii(const std::filesystem::path& folder);

/// The same in binary of the opposite byte order.
void writeStanfordBinary(const std::filesystem::path& folder);

/// tinyViews() in the frames of their pinholes (x right, y up, z backwards), ascii, row 0 at the top.
void writeStanfordPinhole(const std::filesystem::path& folder);

}  // namespace vdbfuse::test
