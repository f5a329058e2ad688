// SPDX-License-Identifier: Apache-2.0
#include "stereo_report.h"

#include <algorithm>
#include <cstdio>

namespace vdbfuse::tool {
namespace {

StereoSummary::Row rowOf(const StereoResult& result, const StereoView& view) {
  StereoSummary::Row row;
  row.name = view.view.name;
  for (const std::size_t partner : view.partners) row.partners.push_back(result.views[partner].view.name);
  row.depths = view.depths;
  row.matching_error_px = view.matching_error_px, row.noise = view.noise;
  const DepthMap& map = view.view.map;
  row.pixels = map.depth.size();
  double sum = 0;
  for (std::size_t i = 0; i < map.depth.size(); ++i) {
    if (map.depth.data()[i] == kInvalidDepth) continue;
    ++row.pixels_with_depth;
    sum += static_cast<double>(map.confidence.data()[i]);
  }
  if (row.pixels_with_depth > 0) row.mean_confidence = sum / static_cast<double>(row.pixels_with_depth);
  return row;
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

std::string lineOf(const StereoSummary::Row& row) {
  return line("%-20s %8zu %5.1f %%  %10.2f %9.3f %9zu  %.4g to %.4g\n", row.name.substr(0, 40).c_str(),
              row.pixels_with_depth,
              100 * static_cast<double>(row.pixels_with_depth) / static_cast<double>(row.pixels),
              row.mean_confidence, row.matching_error_px, row.partners.size(), row.depths.near,
              row.depths.far);
}

}  // namespace

StereoSummary summarise(const StereoResult& result) {
  StereoSummary summary;
  for (const StereoView& view : result.views) summary.rows.push_back(rowOf(result, view));
  summary.steps = result.steps;
  return summary;
}

Json jsonOf(const StereoSummary& summary) {
  Json list = Json::array();
  for (const StereoSummary::Row& row : summary.rows)
    list.push_back({{"name", row.name},
                    {"partners", row.partners},
                    {"near", row.depths.near},
                    {"far", row.depths.far},
                    {"matching_error_px", row.matching_error_px},
                    {"noise_quadratic", row.noise.quadratic},
                    {"pixels", row.pixels},
                    {"pixels_with_depth", row.pixels_with_depth},
                    {"mean_confidence", row.mean_confidence}});
  return list;
}

std::string tableOf(const StereoSummary& summary) {
  std::string text = "photograph             pixels with depth confidence  error px  partners  depths\n";
  const std::size_t views = summary.rows.size();
  std::size_t pixels = 0;
  double seconds = 0, cpu_seconds = 0;
  for (const StereoSummary::Row& row : summary.rows) text += lineOf(row), pixels += row.pixels_with_depth;
  for (const StepTime& step : summary.steps) seconds += step.seconds, cpu_seconds += step.cpu_seconds;
  return text + line("%zu depth maps, %zu pixels with a depth each, %.1f s (%.1f s of processors)\n", views,
                     pixels / std::max<std::size_t>(views, 1), seconds, cpu_seconds);
}

}  // namespace vdbfuse::tool
