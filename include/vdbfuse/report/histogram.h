// SPDX-License-Identifier: Apache-2.0
// Histograms, several in one drawing.
#pragma once

#include <string>
#include <vector>

namespace vdbfuse {

/// Shares of the whole in bins of equal width.
struct Histogram {
  double low = 0, high = 1;
  /// What lies below `low` counts in the first bin, what lies above `high` in the last. Sums to 1, or all 0
  /// when there was nothing to count.
  std::vector<double> shares;
};

/// `weights`: one a value. Values that are not finite do not count. Throws InvalidArgument when the numbers
/// of values and weights differ, high ≤ low, or there are no bins.
Histogram histogramOf(const std::vector<float>& values, const std::vector<double>& weights, double low,
                      double high, int bins);

struct HistogramCurve {
  std::string name;   ///< for the legend
  std::string color;  ///< as CSS writes it
  Histogram histogram;
};

struct HistogramDrawing {
  std::string value_words;  ///< under the axis, with the unit
  std::string share_words;  ///< above the other one
  int width = 640, height = 260;
};

/// An SVG drawing whose lines and words have the colour of the text around it; black in a file of its own.
/// REQUIRES: a curve; all of the same low, high and number of bins.
std::string drawHistograms(const std::vector<HistogramCurve>& curves, const HistogramDrawing& drawing);

}  // namespace vdbfuse
