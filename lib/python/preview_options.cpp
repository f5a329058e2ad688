// SPDX-License-Identifier: Apache-2.0
#include "python/preview_options.h"

#include "python/fuse_options.h"

namespace vdbfuse::python {
namespace {

using O = ScannerOptions;
using V = OptionValue;

}  // namespace

const std::vector<Option<ScannerOptions>>& previewOptions() {
  static const std::vector<Option<O>> options = {
      {"voxel", [](O& o, const V& v) { o.preview.voxel = v.positive(); }},
      {"truncation", [](O& o, const V& v) { o.preview.tsdf.truncation = v.positive(); }},
      {"colors",
       [](O& o, const V& v) { o.preview.tsdf.colors = v.flag() ? TsdfColors::Keep : TsdfColors::None; }},
      {"storage",
       [](O& o, const V& v) {
         o.preview.tsdf.storage =
             v.choice<TsdfStorage>({{"single", TsdfStorage::Single}, {"half", TsdfStorage::Half}});
       }},
      {"weights", [](O& o, const V& v) { o.preview.weights = weightsOf(v); }},
      {"min_weight", [](O& o, const V& v) { o.preview.least_weight = static_cast<float>(v.number()); }},
      {"sensor", [](O& o, const V& v) { o.preview.noise = sensorPreset(v.text()).noise; }},
      {"bbox", [](O& o, const V& v) { o.preview.tsdf.domain = v.box(); }},
  };
  return options;
}

}  // namespace vdbfuse::python
