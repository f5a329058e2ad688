// SPDX-License-Identifier: Apache-2.0
// Plays a folder of depth maps as if they came from a sensor: one thread integrates frame after frame,
// another makes a mesh of what there is, over and over, as a viewer would.
//   example_live [FOLDER [OUT.ply [VOXEL]]]
// Prints how long frames took (median, 99 %) and how often the mesh was new. Without a folder: a synthetic
// room.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/integrator.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace {

using namespace vdbfuse;
using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

ViewSequence syntheticRoom() {
  SynthOptions camera;
  camera.views = 30;
  camera.width = 320, camera.height = 240;
  camera.arc = Arc::Room;
  return SyntheticScan(inRoom(makeScene("figure")), camera).views();
}

void play(const ViewSequence& frames, double voxel, const char* out) {
  IntegratorOptions options;
  options.voxel = voxel;
  options.noise = sensorPreset("kinect").noise;
  Integrator integrator(options);

  std::atomic<bool> done = false;
  std::vector<double> meshing;
  std::thread viewer([&] {
    while (!done) {
      const Clock::time_point begin = Clock::now();
      const TriangleMesh mesh = integrator.mesh();
      if (integrator.meshedLeaves() == 0) continue;  // nothing new
      meshing.push_back(millisecondsSince(begin));
      std::fprintf(stderr, "\rmesh of %zu triangles, %zu of %zu leaves new   ", mesh.triangles.size(),
                   integrator.meshedLeaves(), integrator.leafCount());
    }
  });
  std::vector<double> integrating;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const View view = frames.load(i);  // a sensor would have it in memory
    const Clock::time_point begin = Clock::now();
    integrator.integrate(view);
    integrating.push_back(millisecondsSince(begin));
  }
  done = true;
  viewer.join();

  const TriangleMesh mesh = integrator.mesh();
  std::printf(
      "\n%zu frames, voxel %g: %.1f ms (median), %.1f ms (99 %%), beside a thread that makes meshes\n",
      frames.size(), voxel, quantile(integrating, 0.5), quantile(integrating, 0.99));
  std::printf("%zu meshes: %.0f ms (median), %.0f ms (99 %%)\n", meshing.size(), quantile(meshing, 0.5),
              quantile(meshing, 0.99));
  std::printf("at the end %zu triangles, %zu components; %.1f MB of voxels\n", mesh.triangles.size(),
              topology(mesh).components, 1e-6 * static_cast<double>(integrator.memoryBytes()));
  if (out != nullptr) writeMesh(out, mesh);
}

}  // namespace

int main(int argc, char** argv) try {
  const ViewSequence frames = argc > 1 ? readDepthSet(argv[1]).views : syntheticRoom();
  play(frames, argc > 3 ? std::atof(argv[3]) : 0.01, argc > 2 ? argv[2] : nullptr);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
