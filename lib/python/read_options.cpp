// SPDX-License-Identifier: Apache-2.0
#include "python/read_options.h"

#include <algorithm>
#include <numbers>

#include "vdbfuse/fusion/conventions.h"

namespace vdbfuse::python {
namespace {

using R = ReadRequest;
using V = OptionValue;

const std::vector<std::pair<const char*, DepthKind>> kKinds = {{"z", DepthKind::Z},
                                                               {"range", DepthKind::Range},
                                                               {"disparity", DepthKind::Disparity},
                                                               {"inverse", DepthKind::Inverse}};

void setConvention(R& r, const V& value) {
  r.fix_convention = value.text();
  if (r.fix_convention != "none" && r.fix_convention != "auto" && !conventionNamed(r.fix_convention))
    value.refuse(
        "'none', 'auto', or a list of inverse, transposed, scalar-first, scalar-last, opengl, range, z, "
        "depth*FACTOR");
}

void setIntrinsics(R& r, const V& value) {
  const std::vector<double> v = value.numbers(4);
  r.intrinsics = {{v[0], v[1], v[2], v[3]}};
}

void setMinDepth(R& r, const V& value) {
  r.min_depth = value.number();
  if (r.min_depth < 0) value.refuse("a number that is not negative");
}

}  // namespace

const char* nameOf(DepthKind kind) {
  return std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& entry) { return entry.second == kind; })
      ->first;
}

const std::vector<Option<ReadRequest>>& depthOptions() {
  static const std::vector<Option<R>> options = {
      {"depth_scale", [](R& r, const V& v) { r.depth_scale = v.positive(); }},
      {"depth_kind", [](R& r, const V& v) { r.depth_kind = v.choice(kKinds); }},
      {"baseline", [](R& r, const V& v) { r.baseline = v.positive(); }},
      {"min_depth", setMinDepth},
      {"max_depth", [](R& r, const V& v) { r.max_depth = v.positive(); }},
  };
  return options;
}

const std::vector<Option<ReadRequest>>& readOptions() {
  static const std::vector<Option<R>> options = [] {
    std::vector<Option<R>> all = depthOptions();
    all.insert(all.end(), {{"format", [](R& r, const V& v) { r.format = v.text(); }},
                           {"intrinsics", setIntrinsics},
                           {"splat_step",
                            [](R& r, const V& v) { r.splat_step = v.positive() * std::numbers::pi / 180; }},
                           {"masks", [](R& r, const V& v) { r.masks = v.path(); }},
                           {"fix_convention", setConvention},
                           {"views", [](R& r, const V& v) { r.views = v.count(); }}});
    return all;
  }();
  return options;
}

}  // namespace vdbfuse::python
