// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "vdbfuse/pipeline/plan.h"

namespace vdbfuse {

/// Nothing when the views looked at agree nowhere.
std::optional<Survey> surveyScan(const ViewSequence& views, const ReconstructOptions& options,
                                 const Progress& progress);

}  // namespace vdbfuse
