// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/compare.h"

#include "pipeline/fuse_judged.h"
#include "pipeline/steps.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

void requireUsable(const std::vector<MethodToCompare>& methods) {
  if (methods.empty()) throw InvalidArgument("methods", "there are none");
  for (const MethodToCompare& method : methods) {
    const std::vector<std::string> problems = validate(method.options);
    if (!problems.empty()) throw InvalidArgument("options of " + method.name, problems.front());
  }
}

Progress named(const std::string& method, const Progress& progress) {
  return Progress([&progress, method](std::string_view step, double fraction) {
    progress.report(method + ": " + std::string(step), fraction);
    return true;
  });
}

}  // namespace

void compareMethods(JudgedScan scan, const std::vector<MethodToCompare>& methods,
                    const std::function<void(ComparedMethod)>& take, const Progress& progress) {
  requireUsable(methods);
  useOptions(methods.front().options, scan);
  const double voxel = chooseFrame(scan.judgement.domain, scan.calibration, methods.front().options).voxel;
  for (const MethodToCompare& method : methods) {
    ComparedMethod compared{method.name, method.options, {}};
    compared.options.voxel = voxel, compared.options.resolution = 0;
    compared.measured = restartPeakMemory();
    compared.result = fuseJudged(scan, compared.options, named(method.name, progress));
    compared.peak_memory_bytes = peakMemoryBytes();
    take(std::move(compared));
  }
}

}  // namespace vdbfuse
