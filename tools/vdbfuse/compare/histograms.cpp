// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "compare/pictures.h"
#include "text_file.h"
#include "vdbfuse/report/histogram.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

std::string colorOf(const std::string& method) {
  if (method == "visibility") return "#2f7de1";
  return method == "tsdf" ? "#e07b1f" : "#3f9d57";
}

// One drawing, a curve a method.
struct Curves {
  std::string title, file, words;
  double high;
  int bins;
  std::vector<HistogramCurve> curves = {};

  void add(const std::string& name, const TriangleMesh& mesh, const std::vector<float>& values) {
    if (values.empty()) return;
    curves.push_back({name, colorOf(name), histogramOf(values, vertexAreas(mesh), 0, high, bins)});
  }
};

}  // namespace

std::vector<Drawing> drawHistogramFiles(const fs::path& folder, const MeasuredMeshes& measured) {
  constexpr int kBins = 60;
  // A bin a view, as long as they are wide enough to see.
  const int support_bins = static_cast<int>(std::clamp(std::ceil(measured.largest_support), 8.0, 60.0));
  const std::string words = "distance; the last bar: this and more";
  Curves distance{"Distance of the surface from " + measured.measured_from, "distance", words,
                  measured.largest_distance, kBins};
  Curves missing{"Distance of the reference from the surface", "missing", words, measured.largest_distance,
                 kBins};
  Curves support{"Support of the surface", "support", "agreeing views (TSDF: sum of weights)",
                 measured.largest_support, support_bins};
  for (const ShownMesh& shown : measured.meshes) {
    distance.add(shown.name, shown.mesh, shown.distances);
    missing.add(shown.name, measured.reference, shown.missing);
    support.add(shown.name, shown.mesh, shown.mesh.support);
  }
  std::vector<Drawing> drawings;
  for (const Curves& each : {distance, missing, support}) {
    if (each.curves.empty()) continue;
    drawings.push_back({each.title, fs::path("histograms") / (each.file + ".svg")});
    writeText(folder / drawings.back().file, drawHistograms(each.curves, {each.words, "share of the area"}));
  }
  return drawings;
}

}  // namespace vdbfuse::tool
