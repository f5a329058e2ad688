// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/histogram.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/report/html.h"

namespace vdbfuse {
namespace {

constexpr int kLeft = 52, kRight = 14, kTop = 30, kBottom = 44;  // margins

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// 1, 2 or 5 times a power of ten, so that about `count` of them make `extent`.
double roundStep(double extent, int count) {
  const double raw = extent / count, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= raw) return factor * power;
  return 10 * power;
}

// From values and shares to the drawing.
struct Axes {
  double low, high, most;
  int width, height;
  double x(double value) const { return kLeft + (value - low) / (high - low) * (width - kLeft - kRight); }
  double y(double share) const { return height - kBottom - share / most * (height - kTop - kBottom); }
};

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + anchor + "\">" +
         escapeHtml(words) + "</text>\n";
}

std::string line(double x0, double y0, double x1, double y1, const char* opacity) {
  return "<line x1=\"" + number(x0) + "\" y1=\"" + number(y0) + "\" x2=\"" + number(x1) + "\" y2=\"" +
         number(y1) + "\" stroke=\"currentColor\" stroke-opacity=\"" + opacity + "\"/>\n";
}

std::string axes(const Axes& at, const HistogramDrawing& drawing) {
  std::string svg;
  const double step = roundStep(at.high - at.low, 8), share_step = roundStep(at.most, 4);
  for (int k = 0; k * share_step <= at.most; ++k) {
    const double y = at.y(k * share_step);
    svg += line(kLeft, y, at.width - kRight, y, k == 0 ? "0.8" : "0.15");
    svg += text(kLeft - 8, y + 4, "end", number(100 * k * share_step) + " %");
  }
  for (double k = std::ceil(at.low / step); k * step <= at.high + 1e-9 * step; ++k) {
    svg += line(at.x(k * step), at.height - kBottom, at.x(k * step), at.height - kBottom + 5, "0.8");
    svg += text(at.x(k * step), at.height - kBottom + 19, "middle", number(k * step));
  }
  svg += text(0.5 * (kLeft + at.width - kRight), at.height - 8, "middle", drawing.value_words);
  return svg + text(4, 16, "start", drawing.share_words);
}

std::string curve(const Axes& at, const HistogramCurve& curve) {
  const auto bins = static_cast<double>(curve.histogram.shares.size());
  std::string path = "M" + number(at.x(at.low)) + " " + number(at.y(0));
  for (std::size_t i = 0; i < curve.histogram.shares.size(); ++i) {
    const auto edge = [&](double k) { return number(at.x(at.low + (at.high - at.low) * k / bins)); };
    const std::string y = number(at.y(curve.histogram.shares[i]));
    path += " L" + edge(static_cast<double>(i)) + " " + y + " L" + edge(static_cast<double>(i + 1)) + " " + y;
  }
  path += " L" + number(at.x(at.high)) + " " + number(at.y(0));
  return "<path d=\"" + path + "\" fill=\"" + curve.color + "\" fill-opacity=\"0.13\" stroke=\"" +
         curve.color + "\" stroke-width=\"1.6\" stroke-linejoin=\"round\"/>\n";
}

std::string legend(const std::vector<HistogramCurve>& curves, int width) {
  constexpr int kEntry = 110;
  std::string svg;
  double x = width - kRight - kEntry * static_cast<double>(curves.size());
  for (const HistogramCurve& curve : curves) {
    svg += "<rect x=\"" + number(x) + "\" y=\"6\" width=\"12\" height=\"12\" rx=\"2\" fill=\"" + curve.color +
           "\"/>\n" + text(x + 18, 16, "start", curve.name);
    x += kEntry;
  }
  return svg;
}

}  // namespace

Histogram histogramOf(const std::vector<float>& values, const std::vector<double>& weights, double low,
                      double high, int bins) {
  if (values.size() != weights.size()) throw InvalidArgument("weights", "there must be one a value");
  if (!(high > low)) throw InvalidArgument("high", "must be above low");
  if (bins <= 0) throw InvalidArgument("bins", "must be positive");
  Histogram histogram{low, high, std::vector<double>(static_cast<std::size_t>(bins), 0.0)};
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double place = (values[i] - low) / (high - low) * bins;
    histogram.shares[static_cast<std::size_t>(std::clamp(place, 0.0, bins - 1.0))] += weights[i];
    sum += weights[i];
  }
  if (sum > 0)
    for (double& share : histogram.shares) share /= sum;
  return histogram;
}

std::string drawHistograms(const std::vector<HistogramCurve>& curves, const HistogramDrawing& drawing) {
  const Histogram& first = curves.front().histogram;
  double most = 0;
  for (const HistogramCurve& curve : curves)
    most = std::max(most, *std::max_element(curve.histogram.shares.begin(), curve.histogram.shares.end()));
  const Axes at{first.low, first.high, most > 0 ? 1.05 * most : 1, drawing.width, drawing.height};
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(drawing.width) + " " +
                    number(drawing.height) +
                    "\" font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"currentColor\">\n";
  svg += axes(at, drawing) + legend(curves, drawing.width);
  for (const HistogramCurve& each : curves) svg += curve(at, each);
  return svg + "</svg>\n";
}

}  // namespace vdbfuse
