// SPDX-License-Identifier: Apache-2.0
// How long calibrating and judging take on many small views:
//   judge_benchmark [views=1000] [width=160] [wall]
// `wall`: one is measured behind the object, so that every pixel has a depth.
// Wall-clock seconds of each step and of the parts that report progress, and nanoseconds a (pixel, neighbour)
// pair. Loading includes rendering the scan.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "vdbfuse/pipeline/judge_scan.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;
using Clock = std::chrono::steady_clock;

// When each part reported first and last.
struct Part {
  std::string name;
  Clock::time_point first, last;
};

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

}  // namespace

int main(int argc, char** argv) {
  SynthOptions synth;
  synth.views = argc > 1 ? std::atoi(argv[1]) : 1000;
  synth.width = argc > 2 ? std::atoi(argv[2]) : 160;
  synth.height = synth.width * 3 / 4;
  const bool has_wall = argc > 3 && std::string(argv[3]) == "wall";
  if (has_wall) synth.background = Background::Wall;
  if (synth.views < 2 || synth.width < 16 || (argc > 3 && !has_wall)) {
    std::fprintf(stderr, "usage: judge_benchmark [views] [width] [wall]\n");
    return 2;
  }
  const SyntheticScan scan(makeScene("figure"), hardened(synth));
  std::vector<Part> parts;
  const Progress progress([&](std::string_view name, double) {
    const Clock::time_point now = Clock::now();
    if (parts.empty() || parts.back().name != name) parts.push_back({std::string(name), now, now});
    parts.back().last = now;
    return true;
  });
  const JudgedScan judged = judgeScan(scan.views(), {}, progress);
  std::printf("%d views of %dx%d\n", synth.views, synth.width, synth.height);
  for (const StepTime& s : judged.steps)
    std::printf("%-20s %8.2f s, %8.2f s of processors\n", s.name.c_str(), s.seconds, s.cpu_seconds);
  double pairs = 0;
  for (const JudgedView& view : judged.judgement.judged.views) {
    for (const float d : view.depth) pairs += d != kInvalidDepth ? NeighbourOptions().count : 0;
  }
  for (const Part& p : parts) std::printf("  %-18s %8.2f s\n", p.name.c_str(), seconds(p.last - p.first));
  std::printf("judge: %.0f ns of processors a (pixel, neighbour) pair\n",
              1e9 * judged.steps.back().cpu_seconds / pairs);
  return 0;
}
