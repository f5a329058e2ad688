// SPDX-License-Identifier: Apache-2.0
// Minimum cut against Boost's Boykov–Kolmogorov, in one run on the same instances:
//   mincut_benchmark [side=128] [repetitions=5] [family=all]
// Processor time of the solve alone, median; both get their network ready-made. Fails when a certificate or
// the two flows do.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "mincut/instances.h"
#include "mincut/oracles.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace {

using namespace vdbfuse;

double medianSeconds(int repetitions, const std::function<void()>& call) {
  std::vector<double> seconds;
  for (int i = 0; i < repetitions; ++i) {
    const std::clock_t start = std::clock();
    call();
    seconds.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::ranges::nth_element(seconds, seconds.begin() + repetitions / 2);
  return seconds[repetitions / 2];
}

bool measure(test::Family family, std::uint32_t side, int repetitions) {
  const test::Instance instance = test::gridInstance(family, side, 1);
  Network network;
  const double build = medianSeconds(1, [&] { network = instance.network(); });
  MinCut cut;
  const double ours = medianSeconds(repetitions, [&] { cut = solve(network); });
  std::int64_t boost_flow = 0;
  test::BoostMaxFlow boost(instance);
  const double theirs = medianSeconds(repetitions, [&] { boost_flow = boost.solve(); });
  const bool proven = verify(network, cut).certified() && boost_flow == cut.flow;
  const double millions = network.nodeCount() / 1e6;
  const double source = static_cast<double>(std::ranges::count(cut.sides, CutSide::Source)) / 1e6;
  const auto perNode = [&](std::uint64_t count) { return static_cast<double>(count) / 1e6 / millions; };
  std::printf("%-13s %6.2f %8.3f %8.3f %8.3f %7.2f %7.0f %8.2f %8.2f %8.2f %7.3f  %s\n",
              test::name(family).c_str(), millions, build / millions, ours / millions, theirs / millions,
              theirs / ours, perNode(network.bytes() + cut.statistics.bytes), perNode(cut.statistics.scans),
              perNode(cut.statistics.pushes), perNode(cut.statistics.adoptions), source / millions,
              proven ? "proven" : "WRONG");
  std::fflush(stdout);
  return proven;
}

}  // namespace

int main(int argc, char** argv) {
  const auto side = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 128);
  const int repetitions = argc > 2 ? std::atoi(argv[2]) : 5;
  if (side == 0 || side % 8 != 0 || repetitions < 1) {
    std::fprintf(stderr, "usage: mincut_benchmark [side, a multiple of 8] [repetitions] [family]\n");
    return 2;
  }
  std::printf("%-13s %6s %8s %8s %8s %7s %7s %8s %8s %8s %7s\n", "family", "Mnodes", "build", "solve",
              "Boost", "ratio", "bytes", "scans", "pushes", "adopt", "source");
  std::printf("%-13s %6s %8s %8s %8s %7s %7s %26s\n", "", "", "s/M", "s/M", "s/M", "", "a node", "per node");
  bool all_proven = true;
  for (const test::Family family : test::kFamilies) {
    if (argc > 3 && test::name(family) != argv[3]) continue;
    all_proven = measure(family, side, repetitions) && all_proven;
  }
  return all_proven ? 0 : 1;
}
