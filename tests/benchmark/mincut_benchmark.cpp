// SPDX-License-Identifier: Apache-2.0
// Minimum cut against Boost's Boykov–Kolmogorov, in one run on the same instances (--help lists the options).
// Processor time of the solve alone, median; both get their network ready-made (Boost's in compressed rows,
// which is its fastest). "build" and "verify" are ours. "wall" is the solve by the clock. Fails when a
// certificate or the two flows do.
#include <sys/resource.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "mincut/instances.h"
#include "mincut/oracles.h"
#include "octree/octree_instances.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mincut/dimacs.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace {

using namespace vdbfuse;

struct Settings {
  std::vector<int> grids, octrees;
  int repetitions = 5;
  int threads = 1;
  bool peer = true;
  std::string family;
  std::filesystem::path folder;  ///< to write instances to
  std::vector<std::filesystem::path> files;
};

struct Time {
  double cpu = 0, wall = 0;
};

/// Median of each over some calls; `prepare` is not timed.
Time median(int repetitions, const std::function<void()>& prepare, const std::function<void()>& call) {
  std::vector<double> cpu, wall;
  for (int i = 0; i < repetitions; ++i) {
    prepare();
    const std::clock_t cpu_start = std::clock();
    const auto wall_start = std::chrono::steady_clock::now();
    call();
    cpu.push_back(static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count());
  }
  const auto middle = static_cast<std::size_t>(repetitions / 2);
  std::ranges::nth_element(cpu, cpu.begin() + repetitions / 2);
  std::ranges::nth_element(wall, wall.begin() + repetitions / 2);
  return {cpu[middle], wall[middle]};
}

bool measure(const std::string& name, const NetworkSource& source,
             const std::function<test::Instance()>& graph, const Settings& settings) {
  if (!settings.folder.empty()) {
    const test::Instance instance = graph();
    std::ofstream file(settings.folder / (name + ".max"));
    writeDimacs({instance.terminals, instance.edges, 0}, file);
  }
  const ThreadLimit limit(settings.threads);
  Network network, built;
  MinCut cut;
  bool certified = false;
  const auto nothing = [] {};
  const Time build = median(1, nothing, [&] { built = buildNetwork(source); });
  const Time ours = median(
      settings.repetitions, [&] { network = built; }, [&] { cut = solve(network); });
  const Time check = median(1, nothing, [&] { certified = verify(source, network, cut).certified(); });
  const double millions = static_cast<double>(network.nodeCount()) / 1e6;
  std::int64_t boost_flow = cut.flow;
  double theirs = 0;
  if (settings.peer) {
    test::BoostMaxFlow boost(graph());
    theirs = median(settings.repetitions, nothing, [&] { boost_flow = boost.solve(); }).cpu;
  }
  const auto perNode = [&](std::uint64_t count) { return static_cast<double>(count) / 1e6 / millions; };
  const bool proven = certified && boost_flow == cut.flow;
  std::printf("%-22s %6.2f %8.4f %8.4f %8.4f %8.4f %8.4f %7.2f %7.1f %6.2f %6.2f %6.2f  %s\n", name.c_str(),
              millions, build.cpu / millions, check.cpu / millions, ours.cpu / millions, ours.wall / millions,
              theirs / millions, theirs / ours.cpu, perNode(network.bytes() + cut.statistics.bytes),
              perNode(cut.statistics.scans), perNode(cut.statistics.pushes),
              perNode(cut.statistics.adoptions), proven ? "proven" : "WRONG");
  std::fflush(stdout);
  return proven;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app("Minimum cut against Boost's Boykov-Kolmogorov, on the same instances in one run");
  app.add_option("--grid", settings.grids, "grids of so many cells a side, a multiple of 4");
  app.add_option("--octree", settings.octrees, "octrees of so many finest voxels a side");
  app.add_option("--read", settings.files, "files in DIMACS format")->check(CLI::ExistingFile);
  app.add_option("--write", settings.folder, "write every instance here, in DIMACS format")
      ->check(CLI::ExistingDirectory);
  app.add_option("--family", settings.family, "only this one");
  app.add_option("--repetitions", settings.repetitions, "medians of so many solves")
      ->check(CLI::Range(1, 1000));
  app.add_option("--threads", settings.threads, "of our solver");
  app.add_flag("!--no-peer", settings.peer, "without Boost");
  CLI11_PARSE(app, argc, argv);
  if (settings.grids.empty() && settings.octrees.empty() && settings.files.empty())
    settings.grids = {128}, settings.octrees = {256};
  std::printf("%-22s %6s %8s %8s %8s %8s %8s %7s %7s %6s %6s %6s\n", "instance", "Mnodes", "build", "verify",
              "solve", "wall", "Boost", "ratio", "bytes", "scans", "pushes", "adopt");
  std::printf("%-22s %6s %44s %7s %7s %20s\n", "", "", "seconds a million nodes", "", "a node", "per node");
  bool all_proven = true;
  const auto chosen = [&](const std::string& name) {
    return settings.family.empty() || settings.family == name;
  };
  for (const int side : settings.grids) {
    for (const test::Family family : test::kFamilies) {
      if (!chosen(test::name(family))) continue;
      const test::GridInstance instance = test::gridInstance(family, static_cast<std::uint32_t>(side), 1);
      all_proven &= measure(
          test::name(family) + "-" + std::to_string(side), instance.source(),
          [&] { return instance.graph(); }, settings);
    }
  }
  for (const int resolution : settings.octrees) {
    for (const test::OctreeFamily family : test::kOctreeFamilies) {
      if (!chosen(test::name(family))) continue;
      const test::OctreeInstance instance = test::octreeInstance(family, resolution, 1);
      all_proven &= measure(
          test::name(family) + "-octree-" + std::to_string(resolution), instance.source(),
          [&] { return instance.graph(); }, settings);
    }
  }
  for (const std::filesystem::path& path : settings.files) {
    std::ifstream file(path);
    const MaxFlowProblem problem = readDimacs(file, path);
    all_proven &= measure(
        path.stem().string(), problem.source(),
        [&] {
          return test::Instance{problem.terminals, problem.edges};
        },
        settings);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("peak memory of the process, instances and peer included: %.2f GB\n",
              static_cast<double>(usage.ru_maxrss) / 1e6);
  return all_proven ? 0 : 1;
}
