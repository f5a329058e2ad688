// SPDX-License-Identifier: Apache-2.0
// A judgement on disk, to look at and to hand to another run:
//
// - NAME.png: 8-bit grey, 255 × (1 − ε): white is a certain inlier, black an outlier or no measurement.
// - outliers/NAME.png: 16-bit grey, the same to 0.03 % of ε, and what pixels without a depth say.
// - judgement.json: sensor, calibration, the learned curve ε(c), weights of the views.
// - judgement.txt: the same for reading.
#pragma once

#include <filesystem>
#include <string>

#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {

/// The first members of judgement.json.
struct JudgementOrigin {
  std::string version, input, format;
};

/// The text of judgement.json. Numbers come back as they were.
std::string judgementJson(const JudgedScan& scan, const JudgementOrigin& origin);

/// The text of judgement.txt.
std::string judgementText(const JudgedScan& scan);

/// Fills an existing folder. Each file is complete or absent; for all or none write into a temporary folder
/// and rename it. Throws InvalidArgument when the views' names are not different names of files, IoError.
void writeJudgement(const std::filesystem::path& folder, const JudgedScan& scan,
                    const JudgementOrigin& origin);

/// The judgement of these very views: reconstruct() gives what it gave without the detour, up to 0.03 % of
/// each ε. Throws IoError, with the file, when something is missing, damaged, or of other views: names, order
/// and sizes must be the same.
JudgedScan readJudgement(const std::filesystem::path& folder, const ViewSequence& views,
                         const Progress& progress = {});
/// The same as planned, but for the size of the images.
JudgedScan readJudgement(const std::filesystem::path& folder, const ViewSequence& views, ScanPlan plan,
                         const Progress& progress = {});

}  // namespace vdbfuse
