// SPDX-License-Identifier: Apache-2.0
// Data sets of tinyViews() in formats of depth cameras, spelled out as other programs write them.
#pragma once

#include <filesystem>

#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse::test {

/// ICL-NUIM: associations.txt, livingRoom.gt.freiburg, a left-handed camera.
void writeIclNuim(const std::filesystem::path& folder);
void writeScannet(const std::filesystem::path& folder);
void writePolycam(const std::filesystem::path& folder);
void writeScannerApp(const std::filesystem::path& folder);

/// Depths rounded to whole numbers of `step`, as a 16-bit PNG.
void writeDepthInSteps(const std::filesystem::path& path, const Image<float>& depth, double step);

/// Rows of a matrix with 17 digits, numbers with `separator` between them.
std::string rows(const Eigen::MatrixXd& matrix, const std::string& separator, const std::string& line_end);

}  // namespace vdbfuse::test
