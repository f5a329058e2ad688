// SPDX-License-Identifier: Apache-2.0
#include "stereo/stereo_plan.h"

#include <string>

#include "vdbfuse/base/errors.h"

namespace vdbfuse::stereo {
namespace {

DepthInterval chosenDepths(const StereoPlan& plan, std::size_t index, const StereoOptions& options) {
  const bool is_given = options.min_depth > 0 && options.max_depth > 0;
  DepthInterval depths = is_given ? DepthInterval{} : depthsOf(plan.headers, index, options.domain);
  if (options.min_depth > 0) depths.near = options.min_depth;
  if (options.max_depth > 0) depths.far = options.max_depth;
  if (!(depths.far > depths.near))
    throw InvalidArgument("depths", "nothing is left between " + std::to_string(depths.near) + " and " +
                                        std::to_string(depths.far) + " for photograph " +
                                        plan.headers[index].name);
  return depths;
}

}  // namespace

StereoPlan stereoPlan(const PhotographSequence& photographs, const StereoOptions& options) {
  StereoPlan plan;
  for (std::size_t i = 0; i < photographs.size(); ++i) plan.headers.push_back(photographs.header(i));
  for (std::size_t i = 0; i < photographs.size(); ++i) plan.depths.push_back(chosenDepths(plan, i, options));
  plan.partners = choosePartners(plan.headers, plan.depths, options.partners);
  return plan;
}

}  // namespace vdbfuse::stereo
