// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse::test {

/// A scan of a PTX file, spelled out with streams: columns from the left, each from below, "0 0 0" where the
/// view has no depth; with r g b where `color`.
std::string ptxScan(const View& view, bool color);

/// The tiny scene by two turning scanners, one file.
std::string ptxOfTwoScans();

}  // namespace vdbfuse::test
