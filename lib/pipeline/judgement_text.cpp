// SPDX-License-Identifier: Apache-2.0
#include <cstdarg>
#include <cstdio>

#include "pipeline/judgement_json.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse {
namespace {

[[gnu::format(printf, 1, 2)]] std::string line(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text + std::string("\n");
}

std::string calibrationText(const CalibrationReport& c, const NoiseShape& shape) {
  return line("noise          %.4g at depth %.4g, %s, %s", c.noise_scale, c.median_depth, shape.name.c_str(),
              nameOfLaw(c.noise_exponent)) +
         line("range          %.4g to %.4g", c.near, c.far) +
         line("miss rate      %.1f %%", 100 * c.miss_rate) +
         line("outliers       %.1f %%", 100 * c.outlier_share) +
         line("confidence     %s", nameOf(c.confidence)) + line("point spacing  %.4g", c.point_spacing);
}

std::string curveText(const ReliabilityModel& model) {
  if (model.confidence_bins.empty()) return {};
  std::string text = line("\n%16s  outliers", "confidence below");
  for (std::size_t k = 0; k < model.confidence_bins.size(); ++k)
    text += line("%16.6g  %6.2f %%", model.confidence_bins[k], 100 * model.outlier_by_confidence[k]);
  return text + line("%16s  %6.2f %%", "more", 100 * model.outlier_by_confidence.back());
}

std::string viewsText(const std::vector<JudgedView>& views) {
  std::string text = line("\n%8s %9s %11s %13s  view", "weight", "outliers", "no-returns", "outside mask");
  text += line("%8s %9s %11s", "", "", "trusted");
  for (const JudgedView& view : views) {
    const ViewStatistics s = statistics(view);
    text += line("%8.3f %7.2f %% %9.1f %% %11.1f %%", view.weight, 100 * s.outlier_share,
                 100 * s.no_returns_trusted, 100 * s.outside_mask);
    text.insert(text.size() - 1, "  " + view.name);
  }
  return text;
}

}  // namespace

std::string judgementText(const JudgedScan& scan) {
  return calibrationText(scan.calibration, scan.judgement.judged.sensor.shape) +
         curveText(scan.judgement.model) + viewsText(scan.judgement.judged.views);
}

}  // namespace vdbfuse
