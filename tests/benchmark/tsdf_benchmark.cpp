// SPDX-License-Identifier: Apache-2.0
// tsdf_benchmark FOLDER [--frames N] [--voxel SIZE ...] [--threads N ...]: milliseconds a frame of TSDF
// integration, allocation included, decoding excluded, and the memory of its grid. Truncation 4 voxels.
// peer_integration.py runs it beside Open3D.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/measurement_weight.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/io/depth_set.h"

namespace {

using namespace vdbfuse;
using Clock = std::chrono::steady_clock;

struct Setting {
  const char* name;
  bool weighted;
  TsdfStorage storage;
  Carving carving;
};

constexpr Setting kSettings[] = {
    {"weight 1", false, TsdfStorage::Single, Carving::Off},
    {"weighted", true, TsdfStorage::Single, Carving::Off},
    {"weighted, half", true, TsdfStorage::Half, Carving::Off},
    {"weighted, carving", true, TsdfStorage::Single, Carving::On},
};

// Milliseconds of each frame.
struct Times {
  std::vector<double> frames;
  double mean() const {
    double sum = 0;
    for (const double t : frames) sum += t;
    return sum / static_cast<double>(frames.size());
  }
  double quantile(double q) const {
    std::vector<double> sorted = frames;
    std::sort(sorted.begin(), sorted.end());
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  }
};

void run(const std::vector<View>& views, double voxel, int threads, const Setting& setting) {
  const ThreadLimit limit(threads);
  TsdfOptions options;
  options.truncation = 4 * voxel;
  options.storage = setting.storage;
  options.carving = setting.carving;
  TsdfVolume volume({voxel}, options);
  const WeightOptions weighting;
  const NoiseLaw noise = NoiseLaw::structuredLight();
  Times times;
  std::size_t voxels = 0, carved = 0;
  for (const View& view : views) {
    const auto begin = Clock::now();
    TsdfReport report;
    if (setting.weighted) {
      const Image<float> weights = measurementWeights(view, noise, voxel, weighting);
      report = volume.integrate({view, view.map.depth, &weights});
    } else {
      report = volume.integrate({view, view.map.depth});
    }
    times.frames.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
    voxels += report.voxels, carved += report.before;
  }
  std::printf("| %s | %g | %d | %.2f | %.2f | %.2f | %zu | %.2f | %.0f | %.0f |\n", setting.name, voxel,
              threads, times.mean(), times.quantile(0.5), times.quantile(0.99), volume.leafCount(),
              1e-6 * static_cast<double>(volume.memoryBytes()),
              1e-3 * static_cast<double>(voxels) / (times.mean() * static_cast<double>(views.size())),
              1e-3 * static_cast<double>(carved) / static_cast<double>(views.size()));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How fast does the TSDF integrate?");
  std::string folder;
  std::size_t frames = 100;
  std::vector<double> voxels = {0.01, 0.005};
  std::vector<int> threads = {1, 2};
  app.add_option("folder", folder, "depth maps")->required()->check(CLI::ExistingDirectory);
  app.add_option("--frames", frames, "the first so many");
  app.add_option("--voxel", voxels, "sizes");
  app.add_option("--threads", threads, "numbers");
  CLI11_PARSE(app, argc, argv);
  const ViewSequence sequence = readDepthSet(folder).views.first(frames);
  std::vector<View> views;
  for (std::size_t i = 0; i < sequence.size(); ++i) views.push_back(sequence.load(i));
  std::printf(
      "| setting | voxel | threads | ms a frame | median | 99 %% | leaves | MB | voxels a us | before it |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double voxel : voxels)
    for (const int count : threads)
      for (const Setting& setting : kSettings) run(views, voxel, count, setting);
}
