// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "json_file.h"
#include "vdbfuse/evaluation/evaluate.h"

namespace vdbfuse::tool {

/// JSON has no infinity: what is not finite becomes null.
Json finiteOrNull(double value);
Json orNull(const std::optional<double>& value);

std::vector<double> tausOf(const Evaluation& evaluation);

/// Accuracy, completeness, scores at each tau, IoU, topology and regions: all but what was asked for.
Json evaluationJson(const Evaluation& evaluation);

}  // namespace vdbfuse::tool
