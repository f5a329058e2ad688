// SPDX-License-Identifier: Apache-2.0
// Curless-Levoy fusion is a member of the family (Hernández et al. 2007, section 4.1 and appendix): the
// proof, run.
//   example_09_curless_levoy [FOLDER OF DEPTH MAPS [PLOT.png]]
// Prints three tables: the evidence of one measurement with logistic noise beside (D - d)/w; the evidence of
// a scan beside the Curless-Levoy sum, and the surfaces that both have; the truncation that an outlier share
// stands for. Draws the last.
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/fusion/agreement.h"
#include "vdbfuse/fusion/calibrate.h"
#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/fusion/likelihood.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/surface/extract.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One measurement D with noise scale w: the log-odds of "seen past" at depth d.
void printOneMeasurement() {
  const SensorModel sensor{logisticNoise(), {1, 0, 0}, -kInfinity, kInfinity};
  std::printf("one measurement, logistic noise, no outliers\n%10s %22s %12s\n", "(D-d)/w", "log-odds",
              "difference");
  for (const double u : {-1e6, -30.0, -3.0, -0.1, 0.0, 0.1, 3.0, 30.0, 1e6}) {
    const double odds = logVisibleOdds(sensor, {0.0, 1.0, 0.0}, -u);
    std::printf("%10g %22.15g %12.2g\n", u, odds, odds - u);
  }
}

std::vector<View> loadSome(const ViewSequence& sequence) {
  constexpr std::size_t kMost = 12;
  std::vector<View> views;
  for (std::size_t i = 0; i < std::min(kMost, sequence.size()); ++i) views.push_back(sequence.load(i));
  return views;
}

struct Comparison {
  ScalarGrid evidence, sum;
  double largest =
      0;  ///< difference, relative to 1 + |sum|; single precision of the terms, which cancel in the sum
};

// Both fields on the leaves around the measured surface; unknown where no sensor reports.
Comparison compareFields(const JudgedViews& judged, const GridFrame& frame, const Box& domain) {
  const ScalarGrid support = countAgreement(judged, frame, domain);
  std::vector<Index3> origins;
  for (std::size_t i = 0; i < support.leafCount(); ++i) origins.push_back(support.leaf(i).origin);
  Comparison result{{"evidence", frame, kUnknown, origins}, {"sum", frame, kUnknown, origins}};
  EvidenceOptions options;
  options.rule = EvidenceRule::NoSelfOcclusion;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const ScalarGrid::Leaf ours = result.evidence.leaf(i), theirs = result.sum.leaf(i);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
      points.push_back(frame.toWorld(Index3(ours.origin + Index3(k >> 6, k >> 3 & 7, k & 7))));
    const std::vector<float> e = evidenceAt(judged, points, options);
    const std::vector<double> s = untruncatedSum(judged, points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (s[k] == 0.0) continue;
      ours.values[k] = e[k], theirs.values[k] = static_cast<float>(s[k]);
      result.largest = std::max(result.largest, std::abs(e[k] - s[k]) / (1 + std::abs(s[k])));
    }
  }
  return result;
}

double largestShift(const TriangleMesh& a, const TriangleMesh& b) {
  double largest = 0;
  for (std::size_t v = 0; v < a.vertices.size(); ++v)
    largest = std::max<double>(largest, (a.vertices[v] - b.vertices[v]).norm());
  return largest;
}

bool compareScan(const ViewSequence& sequence) {
  std::vector<View> views = loadSome(sequence);
  const DepthStatistics depths = depthStatistics(views);
  const NoiseLaw noise = guessNoise(views, depths.median);
  Box box;
  for (const View& view : views)
    for (int y = 0; y < view.map.depth.height(); y += 4)
      for (int x = 0; x < view.map.depth.width(); x += 4)
        if (view.map.depth(x, y) != kInvalidDepth) box.extend(worldPoint(view, x, y));
  const GridFrame frame{box.sizes().maxCoeff() / 160};
  const JudgedViews judged = believe(std::move(views), {logisticNoise(), noise, -kInfinity, kInfinity}, 0.0);
  const Comparison fields = compareFields(judged, frame, box);
  const TriangleMesh ours = extractSurface(fields.evidence), theirs = extractSurface(fields.sum);
  std::printf("\na scan of %zu views, %zu voxels around its surfaces\n", judged.views.size(),
              fields.sum.leafCount() * ScalarGrid::kLeafSize);
  std::printf("  evidence against the sum of Curless and Levoy: largest relative difference %.2g\n",
              fields.largest);
  const bool same_size = ours.triangles == theirs.triangles && ours.vertices.size() == theirs.vertices.size();
  std::printf("  surfaces: %zu and %zu triangles, %s", ours.triangles.size(), theirs.triangles.size(),
              same_size ? "the same" : "DIFFERENT");
  if (same_size)
    std::printf("; vertices at most %.2g voxels apart", largestShift(ours, theirs) / frame.voxel);
  std::printf("\n");
  return same_size && fields.largest < 1e-3;
}

constexpr double kShares[] = {0.0001, 0.001, 0.01, 0.1};

// T = w log((2 - e)/e) at the middle of the range.
void printTruncation() {
  std::printf("\nan outlier share is a truncation\n%10s %18s %18s\n", "share", "truncation / w",
              "log-odds in front");
  for (const double share : kShares) {
    const SensorModel sensor{logisticNoise(), {0.001, 0, 0}, 0.0, 2.0};
    const double t = std::log((2 - share) / share);
    std::printf("%10g %18.3f %18.3f\n", share, t, logVisibleOdds(sensor, {1.5, 0.001, share}, 1.0));
  }
}

void drawTruncation(const char* path) {
  constexpr int kWidth = 640, kHeight = 480;
  constexpr double kReach = 12;
  Image<Rgb8> plot(kWidth, kHeight, Rgb8{255, 255, 255});
  const auto dot = [&](double u, double e, Rgb8 color) {
    const int x = static_cast<int>((u / kReach + 1) * kWidth / 2),
              y = static_cast<int>((1 - e / kReach) * kHeight / 2);
    for (int dy = 0; dy < 2; ++dy)
      if (x >= 0 && x < kWidth && y + dy >= 0 && y + dy < kHeight) plot(x, y + dy) = color;
  };
  constexpr Rgb8 kColors[] = {{68, 1, 84}, {49, 104, 142}, {53, 183, 121}, {253, 160, 37}};
  for (double u = -kReach; u < kReach; u += kReach / kWidth) {
    dot(u, 0, {200, 200, 200}), dot(0, u, {200, 200, 200}), dot(u, u, {160, 160, 160});
    for (std::size_t k = 0; k < std::size(kShares); ++k) {
      const SensorModel sensor{logisticNoise(), {0.001, 0, 0}, 0.0, 2.0};
      dot(u, logVisibleOdds(sensor, {1 + u * 0.001, 0.001, kShares[k]}, 1.0), kColors[k]);
    }
  }
  writePng(path, plot);
  std::printf("plot: %s (grey: Curless-Levoy without truncation; dark to light: shares 0.0001 to 0.1)\n",
              path);
}

}  // namespace

int main(int argc, char** argv) try {
  printOneMeasurement();
  bool same;
  if (argc > 1) {
    same = compareScan(readDepthSet(argv[1]).views);
  } else {
    SynthOptions scanner;
    scanner.views = 8;
    scanner.width = 160, scanner.height = 120;
    same = compareScan(SyntheticScan(makeScene("torus"), scanner).views());
  }
  printTruncation();
  if (argc > 2) drawTruncation(argv[2]);
  return same ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
