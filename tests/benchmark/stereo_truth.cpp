// SPDX-License-Identifier: Apache-2.0
// stereo_truth [SCENE:ARC:VIEWS ...]: how far depth maps from the photographs of synthetic scans are from the
// truth. What counts and how errors are measured stands in stereo_score.h.
//   One row a scan, seed and exposure. Of the object's pixels: with texture, seen by at least one and two
//   partners (given texture). Of those that count: with a depth; of these within a half and a quarter of a
//   pixel, median and 90 % error in pixels; within half a pixel in the widest partner; the share of all that
//   count that has a depth within half a pixel. The same for pixels inside a surface only. CPU seconds a
//   view.
//   --gain and --bias: a second row with exposures that differ by view.
//   --curves N: also every N-th pixel inside a surface by hand: mean of the correlation curves against votes.
//   --depths FOLDER: scores a depth set instead of computing one; one scan, views in its order.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>

#include "correlation_curves.h"
#include "stereo_score.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/stereo/stereo.h"

namespace {

using namespace vdbfuse;
using namespace vdbfuse::benchmark;

const std::map<std::string, Arc> kArcs = {{"full", Arc::Full},
                                          {"ring", Arc::Ring},
                                          {"upper", Arc::Upper},
                                          {"front", Arc::Front},
                                          {"room", Arc::Room}};
const std::map<std::string, StereoOptions::Mode> kModes = {{"fast", StereoOptions::Mode::Fast},
                                                           {"paper", StereoOptions::Mode::Paper}};
const std::map<std::string, StereoOptions::CrossCheck> kCrossChecks = {
    {"on", StereoOptions::CrossCheck::On}, {"off", StereoOptions::CrossCheck::Off}};

struct Request {
  std::vector<std::string> scans = {"figure:ring:36", "occluder:front:36", "sphere:upper:36", "torus:full:48",
                                    "box:full:48"};
  std::vector<std::uint64_t> seeds = {1};
  int width = 640, height = 480;
  PhotographOptions photographs;
  StereoOptions stereo;
  std::size_t curves = 0;
  std::string depths;
};

// What is scored: depth maps and the partners each was made with.
struct Depths {
  std::vector<Image<float>> maps;
  std::vector<std::vector<std::size_t>> partners;
  double cpu_seconds = 0;
};

std::vector<std::vector<std::size_t>> defaultPartners(const PhotographSequence& photographs,
                                                      const StereoOptions& options) {
  std::vector<PhotographHeader> headers;
  std::vector<DepthInterval> depths;
  for (std::size_t i = 0; i < photographs.size(); ++i) headers.push_back(photographs.header(i));
  for (std::size_t i = 0; i < photographs.size(); ++i) depths.push_back(depthsOf(headers, i, options.domain));
  return choosePartners(headers, depths, options.partners);
}

Depths depthsFrom(const std::string& folder, const StereoScan& scan, const StereoOptions& options) {
  const DepthSet set = readDepthSet(folder);
  if (set.views.size() != scan.views.size()) throw std::runtime_error("--depths: another number of views");
  Depths result{{}, defaultPartners(scan.photographs, options), 0};
  for (std::size_t i = 0; i < set.views.size(); ++i) {
    result.maps.push_back(set.views.load(i).map.depth);
    if (!result.maps.back().sameSize(scan.views[i].true_depth))
      throw std::runtime_error("--depths: another size");
  }
  return result;
}

Depths computed(const StereoScan& scan, const StereoOptions& options) {
  Depths result;
  const std::clock_t begin = std::clock();
  StereoResult stereo = computeDepthMaps(scan.photographs, options);
  result.cpu_seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  for (const StepTime& step : stereo.steps)
    std::fprintf(stderr, "  %-20s %8.2f s, %8.2f s of processors\n", step.name.c_str(), step.seconds,
                 step.cpu_seconds);
  for (StereoView& view : stereo.views) {
    result.maps.push_back(std::move(view.view.map.depth));
    result.partners.push_back(std::move(view.partners));
  }
  return result;
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::size_t within(const std::vector<PixelError>& errors, double PixelError::*which, double limit) {
  return static_cast<std::size_t>(
      std::count_if(errors.begin(), errors.end(), [&](const PixelError& e) { return e.*which <= limit; }));
}

double quantile(std::vector<PixelError> errors, double q) {
  if (errors.empty()) return 0;
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end(),
                   [](const PixelError& a, const PixelError& b) { return a.median < b.median; });
  return at->median;
}

void printHead() {
  std::printf(
      "| scan | counted px/view | textured, >= 1, >= 2 partners %% | with a depth %% | <= 1/2, 1/4 px %% | "
      "median, 90 %% px | <= 1/2 px in the widest %% | right of all counted %% | inside: with a depth, <= "
      "1/2 "
      "px, right of all %% | invented px/view | CPU s/view "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void printRow(const std::string& name, const StereoScore& s, std::size_t views, double cpu_seconds) {
  using Kind = CountedPixels::Kind;
  std::vector<PixelError> all = s.inside;
  all.insert(all.end(), s.edge.begin(), s.edge.end());
  const std::size_t textured = s.object() - s.of(Kind::Plain), seen = textured - s.of(Kind::Unseen);
  const std::size_t half = within(all, &PixelError::median, 0.5);
  const std::size_t half_inside = within(s.inside, &PixelError::median, 0.5);
  std::printf(
      "| %s | %zu | %.1f %.1f %.1f | %.2f | %.2f %.2f | %.3f %.3f | %.2f | %.2f | %.2f %.2f %.2f | %zu "
      "| %.2f |\n",
      name.c_str(), s.counted() / views, percent(textured, s.object()), percent(seen, textured),
      percent(s.counted(), textured), percent(all.size(), s.counted()), percent(half, all.size()),
      percent(within(all, &PixelError::median, 0.25), all.size()), quantile(all, 0.5), quantile(all, 0.9),
      percent(within(all, &PixelError::widest, 0.5), all.size()), percent(half, s.counted()),
      percent(s.inside.size(), s.of(Kind::Inside)), percent(half_inside, s.inside.size()),
      percent(half_inside, s.of(Kind::Inside)), s.invented / views, cpu_seconds / static_cast<double>(views));
  std::fflush(stdout);
}

// Sampled pixels inside a surface, by the number of partners that see the point.
struct CurveCount {
  std::size_t pixels = 0, mean = 0, voted = 0;
};
using CurveCounts = std::map<int, CurveCount>;

CurveCounts countCurves(const StereoScan& scan, std::size_t index, const std::vector<std::size_t>& partners,
                        std::size_t every) {
  constexpr double kRight = 1;  // the window is not slanted: this asks for the maximum, not its place
  const CountedPixels counted = countedPixels(scan, index, partners);
  const Photograph reference = scan.photographs.load(index);
  std::vector<Photograph> others;
  for (const std::size_t p : partners) others.push_back(scan.photographs.load(p));
  CurveCounts sum;
  std::size_t number = 0;
  for (int y = 0; y < counted.kind.height(); ++y)
    for (int x = 0; x < counted.kind.width(); ++x) {
      if (counted.kind(x, y) != CountedPixels::Kind::Inside || number++ % every != 0) continue;
      const CurveDepths depths = depthsFromCurves(reference, others, x, y);
      const auto right = [&](double d) {
        return d > 0 && pixelError(scan, index, partners, x, y, d).median <= kRight ? 1 : 0;
      };
      CurveCount& count = sum[counted.seen_by(x, y)];
      ++count.pixels, count.mean += right(depths.mean), count.voted += right(depths.voted);
    }
  return sum;
}

void printCurves(const StereoScan& scan, const std::vector<std::vector<std::size_t>>& partners,
                 std::size_t every) {
  std::vector<CurveCounts> each(scan.views.size());
  parallelFor(each.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) each[i] = countCurves(scan, i, partners[i], every);
  });
  CurveCounts sum;
  for (const CurveCounts& counts : each)
    for (const auto& [seen_by, c] : counts) {
      CurveCount& s = sum[seen_by];
      s.pixels += c.pixels, s.mean += c.mean, s.voted += c.voted;
    }
  for (const auto& [seen_by, c] : sum)
    std::printf(
        "  seen by %d partners: %zu pixels, within a pixel: mean of the curves %.1f %%, votes %.1f %%\n",
        seen_by, c.pixels, percent(c.mean, c.pixels), percent(c.voted, c.pixels));
}

void measure(const Request& request, const SyntheticScan& synthetic, const std::string& name) {
  const StereoScan scan = renderStereo(synthetic);
  const Depths depths = request.depths.empty() ? computed(scan, request.stereo)
                                               : depthsFrom(request.depths, scan, request.stereo);
  std::vector<StereoScore> scores(scan.views.size());
  parallelFor(scores.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) scores[i] = score(scan, i, depths.partners[i], depths.maps[i]);
  });
  StereoScore sum;
  for (const StereoScore& s : scores) sum += s;
  printRow(name, sum, scores.size(), depths.cpu_seconds);
  if (request.curves > 0) printCurves(scan, depths.partners, request.curves);
}

// Scene and options of "figure:ring:36".
std::pair<std::string, SynthOptions> parseScan(const Request& request, const std::string& text) {
  const std::size_t first = text.find(':'), last = text.rfind(':');
  const auto arc = first == last ? kArcs.end() : kArcs.find(text.substr(first + 1, last - first - 1));
  if (arc == kArcs.end()) throw std::runtime_error("expected SCENE:ARC:VIEWS, found '" + text + "'");
  SynthOptions options;
  options.arc = arc->second, options.views = std::stoi(text.substr(last + 1));
  options.width = request.width, options.height = request.height;
  options.noise_scale = 0, options.confidence = ConfidenceKind::None;
  return {text.substr(0, first), options};
}

void run(const Request& request) {
  printHead();
  PhotographOptions plain = request.photographs;
  plain.gain = 1, plain.bias = 0;
  std::vector<PhotographOptions> exposures = {plain};
  if (request.photographs.gain != 1 || request.photographs.bias != 0)
    exposures.push_back(request.photographs);
  for (const std::string& text : request.scans)
    for (const std::uint64_t seed : request.seeds)
      for (const PhotographOptions& exposure : exposures) {
        auto [scene, options] = parseScan(request, text);
        options.seed = seed, options.photographs = exposure;
        char name[96];
        std::snprintf(name, sizeof name, "%s, seed %llu%s", text.c_str(),
                      static_cast<unsigned long long>(seed),
                      &exposure == &exposures.front() ? "" : ", exposed");
        measure(request, SyntheticScan(makeScene(scene), options), name);
      }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Are depth maps from photographs right?");
  Request request;
  StereoOptions& stereo = request.stereo;
  app.add_option("scans", request.scans, "SCENE:ARC:VIEWS ...");
  app.add_option("--seed", request.seeds, "of texture, exposure and noise");
  app.add_option("--width", request.width)->capture_default_str();
  app.add_option("--height", request.height)->capture_default_str();
  app.add_option("--gain", request.photographs.gain, "of the second row");
  app.add_option("--bias", request.photographs.bias, "of the second row, grey levels");
  app.add_option("--image-noise", request.photographs.noise)->capture_default_str();
  app.add_option("--gloss", request.photographs.gloss)->capture_default_str();
  app.add_option("--mode", stereo.mode)->transform(CLI::CheckedTransformer(kModes));
  app.add_option("--cross-check", stereo.cross_check)->transform(CLI::CheckedTransformer(kCrossChecks));
  app.add_option("--sweeps", stereo.surface_sweeps)->capture_default_str();
  app.add_option("--window", stereo.window_px)->capture_default_str();
  app.add_option("--partners", stereo.partners.count)->capture_default_str();
  app.add_option("--max-angle", stereo.partners.max_angle_deg)->capture_default_str();
  app.add_option("--min-confidence", stereo.min_confidence)->capture_default_str();
  app.add_option("--curves", request.curves, "every N-th pixel");
  app.add_option("--depths", request.depths, "a depth set on disk")->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);
  try {
    run(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "stereo_truth: %s\n", error.what());
    return 1;
  }
  return 0;
}
