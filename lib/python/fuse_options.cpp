// SPDX-License-Identifier: Apache-2.0
#include "python/fuse_options.h"

#include <algorithm>

namespace vdbfuse::python {
namespace {

using R = FuseRequest;
using V = OptionValue;
using Options = std::vector<Option<FuseRequest>>;

double notNegative(const V& value) {
  const double number = value.number();
  if (number < 0) value.refuse("a number that is not negative");
  return number;
}

double shareIn(const V& value, double low, double high) {
  const double share = value.number();
  if (!(share >= low && share < high))
    value.refuse("a number in [" + std::to_string(low) + ", " + std::to_string(high) + ")");
  return share;
}

void setOutliers(R& r, const V& value) {
  if (!value.isText("auto")) r.options.outliers = shareIn(value, 0, 1);
}

void setThickness(R& r, const V& value) {
  if (value.isText("auto")) return;
  r.options.thickness = value.isText("off") ? 0.0 : value.positive();
}

void setBorder(R& r, const V& value) {
  if (value.isText("auto")) return;
  r.options.border =
      value.choice<Border>({{"outside", Border::Outside}, {"solid", Border::Solid}, {"free", Border::Free}});
}

void setTruncation(R& r, const V& value) {
  TsdfMethod& tsdf = r.options.tsdf;
  if (value.isText("outliers")) {
    tsdf.otherwise = TsdfMethod::Truncation::FromOutliers;
  } else if (!value.isText("auto")) {
    tsdf.truncation = value.positive();
  }
}

void setStart(R& r, const V& value) {
  ReconstructOptions& o = r.options;
  o.tsdf.start = std::make_shared<TsdfVolume>(TsdfVolume::read(value.path()));
  o.voxel = o.tsdf.start->frame().voxel, o.method = Method::Tsdf;
}

void setColor(R& r, const V& value) { r.has_colors = value.choice<bool>({{"auto", true}, {"none", false}}); }

Options gridOptions() {
  return {
      {"voxel", [](R& r, const V& v) { r.options.voxel = v.positive(); }},
      {"resolution", [](R& r, const V& v) { r.options.resolution = v.whole(); }},
      {"max_level", [](R& r, const V& v) { r.options.max_level = v.whole(); }},
      {"border", setBorder},
      {"method",
       [](R& r, const V& v) {
         r.options.method = v.choice<Method>({{"visibility", Method::Visibility}, {"tsdf", Method::Tsdf}});
       }},
      {"judgement", [](R& r, const V& v) { r.judgement = v.path(); }},
      {"color", setColor},
      {"grids",
       [](R& r, const V& v) {
         if (v.flag()) r.options.grids = ReconstructOptions::Grids::Keep;
       }},
  };
}

Options energyOptions() {
  return {
      {"rule",
       [](R& r, const V& v) {
         r.options.evidence.rule =
             v.choice<EvidenceRule>({{"outside", EvidenceRule::Outside},
                                     {"paper", EvidenceRule::Paper},
                                     {"no-self-occlusion", EvidenceRule::NoSelfOcclusion},
                                     {"constant", EvidenceRule::Constant}});
       }},
      {"visibility_prior", [](R& r, const V& v) { r.options.visibility_prior = v.positive(); }},
      {"visibility", [](R& r, const V& v) { r.options.evidence.visibility = shareIn(v, 0, 1); }},
      {"prior", [](R& r, const V& v) { r.options.evidence.prior = v.number(); }},
      {"balloon", [](R& r, const V& v) { r.options.evidence.balloon = v.number(); }},
      {"mask_error", [](R& r, const V& v) { r.options.evidence.mask_error = shareIn(v, 1e-6, 0.5); }},
      {"thickness", setThickness},
      {"depth_prior", [](R& r, const V& v) { r.options.prior_decay = v.positive(); }},
      {"least_cost", [](R& r, const V& v) { r.options.least_cost = notNegative(v); }},
      {"lambda_", [](R& r, const V& v) { r.options.lambda = v.positive(); }},
      {"mu", [](R& r, const V& v) { r.options.mu = notNegative(v); }},
  };
}

Options surfaceOptions() {
  using Kind = CompletionOptions::Kind;
  return {
      {"smoothing_voxels", [](R& r, const V& v) { r.options.smoothing_voxels = notNegative(v); }},
      {"completion",
       [](R& r, const V& v) {
         r.options.completion.kind = v.choice<Kind>({{"isotropic", Kind::Isotropic}, {"none", Kind::None}});
       }},
      {"trim", [](R& r, const V& v) { r.options.trim = notNegative(v); }},
      {"min_component", [](R& r, const V& v) { r.options.min_component = v.positive(); }},
      {"simplify", [](R& r, const V& v) { r.options.simplify = v.count(); }},
  };
}

Options tsdfOptions() {
  return {
      {"truncation", setTruncation},
      {"continue_", setStart},
      {"carve",
       [](R& r, const V& v) {
         if (v.flag()) r.options.tsdf.carving = TsdfMethod::Carving::On;
       }},
      {"weights", [](R& r, const V& v) { r.options.tsdf.weights = weightsOf(v); }},
      {"min_weight", [](R& r, const V& v) { r.options.tsdf.least_weight = notNegative(v); }},
      {"close_gaps", [](R& r, const V& v) { r.options.tsdf.close_gaps = v.whole(); }},
      {"trim_rim", [](R& r, const V& v) { r.options.tsdf.trim_rim = v.whole(); }},
  };
}

}  // namespace

WeightOptions weightsOf(const OptionValue& value) {
  const std::vector<std::string> words = value.words();
  const auto has = [&](const char* name) {
    return std::find(words.begin(), words.end(), name) != words.end();
  };
  const WeightOptions weights{has("confidence"), has("noise"), has("incidence"), has("silhouette")};
  const std::ptrdiff_t known = weights.confidence + weights.noise + weights.incidence + weights.silhouette +
                               std::count(words.begin(), words.end(), "none");
  if (known != std::ssize(words))
    value.refuse("some of 'confidence', 'noise', 'incidence', 'silhouette', or 'none'");
  return weights;
}

const std::vector<Option<FuseRequest>>& sensorOptions() {
  using NoReturn = JudgeOptions::NoReturn;
  static const Options options = {
      {"bbox", [](R& r, const V& v) { r.options.domain = v.box(); }},
      {"noise", [](R& r, const V& v) { r.options.noise_shape = noiseShape(v.text()); }},
      {"sensor", [](R& r, const V& v) { r.options.noise = sensorPreset(v.text()).noise; }},
      {"noise_scale", [](R& r, const V& v) { r.options.noise_scale = v.positive(); }},
      {"outliers", setOutliers},
      {"no_reliability",
       [](R& r, const V& v) {
         constexpr double kBelieveAll = 0.01;
         if (v.flag()) r.options.outliers = kBelieveAll;
       }},
      {"no_denial",
       [](R& r, const V& v) {
         if (v.flag()) r.options.judge.denial = JudgeOptions::Denial::Skip;
       }},
      {"no_return",
       [](R& r, const V& v) {
         r.options.judge.no_return = v.choice<NoReturn>(
             {{"ignore", NoReturn::Ignore}, {"free", NoReturn::Free}, {"auto", NoReturn::Auto}});
       }},
      {"memory", [](R& r, const V& v) { r.options.memory = v.count(); }},
      {"threads", [](R& r, const V& v) { r.threads = static_cast<int>(v.count()); }},
  };
  return options;
}

const std::vector<Option<FuseRequest>>& fuseOptions() {
  static const Options options = [] {
    Options all = sensorOptions();
    for (const Options& more : {gridOptions(), energyOptions(), surfaceOptions(), tsdfOptions()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return options;
}

}  // namespace vdbfuse::python
